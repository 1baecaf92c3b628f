#include "fem/supernodal/unit_loads.h"

#include <cblas.h>
#include <omp.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "fem/supernodal/condensed_mass.h"
#include "fem/supernodal/large_pages.h"
#include "fem/supernodal/supernodal_solve.h"
#include "mesh/base/memory.h"

/* WIDTH: columns of a block. SHARE: a subtree has at most that part of the rows. */
enum { WIDTH = 160, SHARE = 2, NOWHERE = -1 };

static const double SUBTREES = 0.8; /* of the time, roughly */

typedef struct {
  const fem_unit_loads *of;
  fem_loaded_body       body;
  int                   n, n_top;      /* rows; those in no subtree */
  int                  *node;          /* [n / 3] node at each place */
  int                  *owner;         /* [n] */
  int                  *below;         /* [n_panels] */
  bool                 *in_top;        /* [n_panels] */
  int                  *root, n_roots; /* last panels of the subtrees */
  int                  *top_node;      /* [n / 3] index of a place in the top, or NOWHERE */
  int                  *top_row;       /* [n_top] */
  double               *phi;           /* [n][modes] in the factor's order */
  double               *top_phi;       /* [n_top][modes] */
  double               *part;          /* [modes][n_loads] phi^T K^-1 b */
  int                  *entry, *load;  /* of fem_loaded_body */
  double               *weight;
  int                   n_blocks; /* of columns */
  double              **V;        /* [n_blocks][n_top][WIDTH] V_0 of the top */
  fem_condensed       **subtree;  /* [n_roots] */
  double              **lag;      /* [n_roots][loads][modes] b^T (phi - G phi_beyond) */
  double               *R, *R2;   /* [n_loads][n_loads] */
  double               *trace;    /* [modes][n_loads] phi^T M V_0, which rounding leaves */
  atomic_bool           stopped;  /* by go_on */
} problem;

/* Of one thread. */
typedef struct {
  double *Z;      /* [n_top][WIDTH] M V_0, of the top */
  double *q, *Qq; /* [most size][WIDTH] coordinates of a subtree, and Q times them */
  double *work;   /* [most_rows][WIDTH] */
  double *w;      /* [modes][WIDTH] sum of Q q at the modes */
  int    *at;     /* [most_rows] */
} workspace;

/* ------------------------------------------------------------------ parts of the tree */

static int columns_below(const fem_supernodes *s, const int *below, int k) {
  return s->panel[k].first + s->panel[k].columns - s->panel[below[k]].first;
}

static int parent_of(const problem *p, int k) {
  const fem_supernodes *s   = p->of->tree.panels;
  const fem_panel      *own = &s->panel[k];
  return p->owner[fem_supernodes_row(s, own->row + (size_t)own->columns)];
}

/* First panel of each subtree that is a range of panels. */
static void find_ranges(problem *p, int *size) {
  const fem_supernodes *s = p->of->tree.panels;
  for (int k = 0; k < s->n_panels; k++) {
    p->below[k] = k;
    size[k]     = 1;
    for (int c = 0; c < s->panel[k].columns; c++) p->owner[s->panel[k].first + c] = k;
  }
  for (int k = 0; k < s->n_panels; k++) {
    const fem_panel *own = &s->panel[k];
    if (k - p->below[k] + 1 != size[k]) p->below[k] = NOWHERE;
    if (own->rows == own->columns) continue;
    const int up = parent_of(p, k);
    size[up] += size[k];
    if (p->below[k] < p->below[up]) p->below[up] = p->below[k];
  }
}

/* A range of panels with rows beyond, and not too large. */
static bool may_be_subtree(const problem *p, int k) {
  const fem_panel *own = &p->of->tree.panels->panel[k];
  return own->rows > own->columns && p->below[k] >= 0 &&
         columns_below(p->of->tree.panels, p->below, k) <= p->n / SHARE;
}

static void cut(problem *p) {
  const fem_supernodes *s    = p->of->tree.panels;
  int                  *size = shb_alloc((size_t)s->n_panels + 1, sizeof *size);
  find_ranges(p, size);
  free(size);
  for (int k = 0; k < s->n_panels; k++) p->in_top[k] = true;
  for (int k = s->n_panels; k-- > 0;)
    if (p->in_top[k] && may_be_subtree(p, k))
      for (int i = p->below[k]; i <= k; i++) p->in_top[i] = false;
  for (int k = 0; k < s->n_panels; k++)
    if (!p->in_top[k] && p->in_top[parent_of(p, k)]) p->root[p->n_roots++] = k;
  for (int i = 0; i < p->n / 3; i++) {
    p->top_node[i] = NOWHERE;
    if (!p->in_top[p->owner[3 * i]]) continue;
    p->top_node[i] = p->n_top / 3;
    for (int d = 0; d < 3; d++) p->top_row[p->n_top++] = 3 * i + d;
  }
}

static int row_of(const problem *p, int dof) {
  return 3 * p->of->tree.place[dof / 3] + dof % 3;
}

/* Entries of all loads by rows. */
static void sort_entries(problem *p) {
  const fem_unit_loads *of = p->of;
  memset(p->entry, 0, ((size_t)p->n + 1) * sizeof *p->entry);
  for (int e = 0; e < of->start[of->n_loads]; e++) p->entry[row_of(p, of->row[e]) + 1]++;
  for (int i = 0; i < p->n; i++) p->entry[i + 1] += p->entry[i];
  for (int c = 0; c < of->n_loads; c++)
    for (int e = of->start[c]; e < of->start[c + 1]; e++) {
      const int at  = p->entry[row_of(p, of->row[e])]++;
      p->load[at]   = c;
      p->weight[at] = of->weight[e];
    }
  for (int i = p->n; i > 0; i--) p->entry[i] = p->entry[i - 1];
  p->entry[0] = 0;
}

static void order_modes(problem *p) {
  const fem_unit_loads *of    = p->of;
  const size_t          modes = (size_t)of->modes, n = (size_t)p->n, loads = (size_t)of->n_loads;
  for (size_t i = 0; i < n; i++)
    for (size_t m = 0; m < modes; m++)
      p->phi[(size_t)row_of(p, (int)i) * modes + m] = of->phi[m * n + i];
  for (size_t i = 0; i < (size_t)p->n_top; i++)
    memcpy(p->top_phi + i * modes, p->phi + (size_t)p->top_row[i] * modes, modes * sizeof(double));
  for (size_t c = 0; c < loads; c++)
    for (int e = of->start[c]; e < of->start[c + 1]; e++)
      for (size_t m = 0; m < modes; m++)
        p->part[m * loads + c] +=
            of->weight[e] * of->phi[m * n + (size_t)of->row[e]] / of->lambda[m];
}

/* ------------------------------------------------------------------ memory */

static void allocate(problem *p) {
  const fem_unit_loads *of = p->of;
  const size_t          n = (size_t)p->n, panels = (size_t)of->tree.panels->n_panels,
               modes = (size_t)of->modes;
  const size_t loads = (size_t)of->n_loads, entries = (size_t)of->start[of->n_loads];
  p->node     = shb_alloc(n / 3 + 1, sizeof *p->node);
  p->owner    = shb_alloc(n + 1, sizeof *p->owner);
  p->below    = shb_alloc(panels + 1, sizeof *p->below);
  p->in_top   = shb_alloc(panels + 1, sizeof *p->in_top);
  p->root     = shb_alloc(panels + 1, sizeof *p->root);
  p->top_node = shb_alloc(n / 3 + 1, sizeof *p->top_node);
  p->top_row  = shb_alloc(n + 1, sizeof *p->top_row);
  p->phi      = shb_alloc(n * modes + 1, sizeof *p->phi);
  p->part     = shb_alloc_zeroed(modes * loads + 1, sizeof *p->part);
  p->trace    = shb_alloc_zeroed(modes * loads + 1, sizeof *p->trace);
  p->entry    = shb_alloc(n + 2, sizeof *p->entry);
  p->load     = shb_alloc(entries + 1, sizeof *p->load);
  p->weight   = shb_alloc(entries + 1, sizeof *p->weight);
}

static int width_of(const problem *p, int block) {
  const int left = p->of->n_loads - block * WIDTH;
  return left < WIDTH ? left : WIDTH;
}

static void allocate_top(problem *p) {
  const size_t rows = (size_t)p->n_top;
  p->n_blocks       = (p->of->n_loads + WIDTH - 1) / WIDTH;
  p->top_phi        = shb_alloc(rows * (size_t)p->of->modes + 1, sizeof *p->top_phi);
  p->subtree        = shb_alloc_zeroed((size_t)p->n_roots + 1, sizeof(fem_condensed *));
  p->lag            = shb_alloc_zeroed((size_t)p->n_roots + 1, sizeof *p->lag);
  p->V              = shb_alloc_zeroed((size_t)p->n_blocks + 1, sizeof *p->V);
  for (int i = 0; i < p->n_blocks; i++)
    p->V[i] = fem_large_alloc(rows * (size_t)width_of(p, i) + 1, sizeof(double));
}

static void free_problem(problem *p) {
  for (int i = 0; i < p->n_blocks; i++) free(p->V[i]);
  for (int i = 0; i < p->n_roots; i++) {
    fem_condensed_free(p->subtree[i]);
    free(p->lag[i]);
  }
  free(p->V);
  free(p->subtree);
  free(p->lag);
  free(p->node);
  free(p->owner);
  free(p->below);
  free(p->in_top);
  free(p->root);
  free(p->top_node);
  free(p->top_row);
  free(p->phi);
  free(p->top_phi);
  free(p->part);
  free(p->trace);
  free(p->entry);
  free(p->load);
  free(p->weight);
}

static void create_workspace(const problem *p, workspace *w) {
  size_t       size = 0, modes = (size_t)p->of->modes;
  const size_t rows = (size_t)p->of->tree.panels->most_rows;
  for (int i = 0; i < p->n_roots; i++)
    if ((size_t)p->subtree[i]->size > size) size = (size_t)p->subtree[i]->size;
  w->Z    = fem_large_alloc(((size_t)p->n_top + 1) * WIDTH, sizeof *w->Z);
  w->q    = shb_alloc((size + 1) * WIDTH, sizeof *w->q);
  w->Qq   = shb_alloc((size + 1) * WIDTH, sizeof *w->Qq);
  w->work = shb_alloc((rows + 1) * WIDTH, sizeof *w->work);
  w->w    = shb_alloc((modes + 1) * WIDTH, sizeof *w->w);
  w->at   = shb_alloc(rows + 1, sizeof *w->at);
}

static void free_workspace(workspace *w) {
  free(w->Z);
  free(w->q);
  free(w->Qq);
  free(w->work);
  free(w->w);
  free(w->at);
}

/* ------------------------------------------------------------------ subtrees */

/* b^T (phi - G phi_beyond): what a mode moves the loads by beyond the static answer to its motion
 * of the rows beyond. */
static void find_lag(problem *p, int i) {
  const fem_condensed  *c     = p->subtree[i];
  const size_t          modes = (size_t)p->of->modes, loads = (size_t)c->loads;
  const fem_supernodes *s     = p->of->tree.panels;
  const int             first = s->panel[p->below[p->root[i]]].first;
  const int             end   = s->panel[p->root[i]].first + s->panel[p->root[i]].columns;
  double               *lag = p->lag[i] = shb_alloc_zeroed(loads * modes + 1, sizeof *lag);
  int                  *place           = shb_alloc((size_t)p->of->n_loads + 1, sizeof *place);
  for (int k = 0; k < c->loads; k++) place[c->load[k]] = k;
  for (int r = first; r < end; r++)
    for (int e = p->entry[r]; e < p->entry[r + 1]; e++)
      for (size_t m = 0; m < modes; m++)
        lag[(size_t)place[p->load[e]] * modes + m] += p->weight[e] * p->phi[(size_t)r * modes + m];
  for (int a = 0; a < c->beyond; a++)
    for (size_t k = 0; k < loads; k++)
      for (size_t m = 0; m < modes; m++)
        lag[k * modes + m] -= c->U[(size_t)a * loads + k] * p->phi[(size_t)c->row[a] * modes + m];
  free(place);
}

static bool ask(problem *p, double share) {
  if (!p->of->go_on(p->of->context, share)) p->stopped = true;
  return !p->stopped;
}

static bool go_on(void *context, double share) {
  return ask(context, SUBTREES * share);
}

/* Bytes that are still to be taken: vectors above the subtrees, modes, both terms, workspaces and
 * the matrices of subtrees. The stack is freed before the workspaces are made. */
static double bytes_needed(const problem *p, size_t stack) {
  const double loads = p->of->n_loads, modes = p->of->modes, top = p->n_top;
  const int    most    = omp_get_max_threads();
  const double threads = most < p->n_blocks ? most : p->n_blocks;
  double       numbers = loads * (top + 2 * loads) + modes * (p->n + top), size = 0;
  for (int i = 0; i < p->n_roots; i++) {
    const fem_condensed *c = p->subtree[i];
    numbers += (double)fem_lower_numbers(c->size) + c->loads * ((double)c->loads + c->beyond);
    if (c->size > size) size = c->size;
  }
  const double blocks = threads * WIDTH * (top + 2 * size + p->of->tree.panels->most_rows);
  return 8 * (numbers + (blocks > (double)stack ? blocks : (double)stack));
}

static fem_loads_end condense_subtrees(problem *p) {
  p->body     = (fem_loaded_body){.panels  = p->of->tree.panels,
                                  .value   = p->of->tree.value,
                                  .owner   = p->owner,
                                  .below   = p->below,
                                  .place   = p->of->tree.place,
                                  .node    = p->node,
                                  .start   = p->of->node_start,
                                  .column  = p->of->node_column,
                                  .mass    = p->of->node_mass,
                                  .modes   = p->of->modes,
                                  .phi     = p->phi,
                                  .n_loads = p->of->n_loads,
                                  .entry   = p->entry,
                                  .load    = p->load,
                                  .weight  = p->weight,
                                  .go_on   = go_on,
                                  .context = p};
  size_t most = 0;
  for (int i = 0; i < p->n_roots; i++) {
    size_t stack  = 0;
    p->subtree[i] = fem_condensed_create(&p->body, p->root[i], &stack);
    if (stack > most) most = stack;
  }
  if (bytes_needed(p, most) > p->of->room) return FEM_LOADS_NO_ROOM;
  order_modes(p);
  double *stack = fem_large_alloc(most + 1, sizeof *stack);
  for (int i = 0; i < p->n_roots && !p->stopped; i++)
    if (fem_condense(&p->body, p->root[i], stack, p->subtree[i])) find_lag(p, i);
  free(stack);
  return p->stopped ? FEM_LOADS_STOPPED : FEM_LOADS_SOLVED;
}

/* ------------------------------------------------------------------ rows above the subtrees */

static double *top_row(const problem *p, double *x, int row, size_t count) {
  return x + (3 * (size_t)p->top_node[row / 3] + (size_t)(row % 3)) * count;
}

static void solve_top(const problem *p, const workspace *w, int count, double *x) {
  const fem_supernodes *s = p->of->tree.panels;
  for (int pass = 0; pass < 2; pass++)
    for (int i = 0; i < s->n_panels; i++) {
      const int        k   = pass == 0 ? i : s->n_panels - 1 - i;
      const fem_panel *own = &s->panel[k];
      if (!p->in_top[k]) continue;
      for (int r = own->columns; r < own->rows; r++) {
        const int row           = fem_supernodes_row(s, own->row + (size_t)r);
        w->at[r - own->columns] = 3 * p->top_node[row / 3] + row % 3;
      }
      double       *rows = top_row(p, x, own->first, (size_t)count);
      const double *L    = p->of->tree.value + own->value;
      if (pass == 0)
        fem_panel_forward(own, L, w->at, count, rows, x, w->work);
      else
        fem_panel_backward(own, L, w->at, count, rows, x, w->work);
    }
}

/* V_0 of a block of loads. */
static void solve_block(const problem *p, const workspace *w, int block) {
  const int    count = width_of(p, block), first = block * WIDTH, modes = p->of->modes;
  const size_t n = (size_t)count;
  double      *V = p->V[block];
  memset(V, 0, (size_t)p->n_top * n * sizeof *V);
  for (int i = 0; i < p->n_top; i++)
    for (int e = p->entry[p->top_row[i]]; e < p->entry[p->top_row[i] + 1]; e++)
      if (p->load[e] >= first && p->load[e] < first + count)
        V[(size_t)i * n + (size_t)(p->load[e] - first)] += p->weight[e];
  for (int i = 0; i < p->n_roots; i++) {
    const fem_condensed *c = p->subtree[i];
    for (int k = 0; k < c->loads; k++) {
      if (c->load[k] < first || c->load[k] >= first + count) continue;
      for (int a = 0; a < c->beyond; a++)
        top_row(p, V, c->row[a], n)[c->load[k] - first] +=
            c->U[(size_t)a * (size_t)c->loads + (size_t)k];
    }
  }
  solve_top(p, w, count, V);
  if (modes > 0)
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, p->n_top, count, modes, -1, p->top_phi,
                modes, p->part + first, p->of->n_loads, 1, V, count);
}

/* ------------------------------------------------------------------ terms */

/* Z = M V among the rows above the subtrees. */
static void multiply_top(const problem *p, int count, const double *V, double *Z) {
  const fem_unit_loads *of     = p->of;
  const size_t          length = 3 * (size_t)count;
  memset(Z, 0, (size_t)p->n_top * (size_t)count * sizeof *Z);
  for (int i = 0; i < p->n_top / 3; i++) {
    const int node = p->node[p->top_row[3 * i] / 3];
    for (int k = of->node_start[node]; k < of->node_start[node + 1]; k++) {
      const int at = p->top_node[of->tree.place[of->node_column[k]]];
      if (at != NOWHERE)
        cblas_daxpy((int)length, of->node_mass[k], V + (size_t)at * length, 1,
                    Z + (size_t)i * length, 1);
    }
  }
}

/* Coordinates of a subtree for the loads of a block. */
static void fill_coordinates(const problem *p, const fem_condensed *c, int block, double *q) {
  const int    first = block * WIDTH, count = width_of(p, block);
  const size_t n = (size_t)count;
  for (int a = 0; a < c->beyond; a++)
    memcpy(q + (size_t)a * n, top_row(p, p->V[block], c->row[a], n), n * sizeof *q);
  memset(q + (size_t)c->beyond * n, 0, (size_t)c->loads * n * sizeof *q);
  for (int k = 0; k < c->loads; k++)
    if (c->load[k] >= first && c->load[k] < first + count)
      q[(size_t)(c->beyond + k) * n + (size_t)(c->load[k] - first)] = 1;
  for (int m = 0; m < p->of->modes; m++)
    memcpy(q + (size_t)(c->beyond + c->loads + m) * n,
           p->part + (size_t)m * (size_t)p->of->n_loads + (size_t)first, n * sizeof *q);
}

/* R of the subtree's loads: U^T V_0 beyond, their own flexibility, and the lag of the modes. */
static void add_flexibility(const problem *p, int i, int block, const double *q, double *work) {
  const fem_condensed *c     = p->subtree[i];
  const int            count = width_of(p, block), first = block * WIDTH, modes = p->of->modes;
  const size_t         n = (size_t)count;
  if (c->loads == 0) return;
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, c->loads, count, c->beyond, 1, c->U,
              c->loads, q, count, 0, work, count);
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, c->loads, count, c->loads, 1, c->F,
              c->loads, q + (size_t)c->beyond * n, count, 1, work, count);
  if (modes > 0)
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, c->loads, count, modes, -1, p->lag[i],
                modes, q + (size_t)(c->beyond + c->loads) * n, count, 1, work, count);
  for (int k = 0; k < c->loads; k++)
    cblas_daxpy(count, 1, work + (size_t)k * n, 1,
                p->R + (size_t)c->load[k] * (size_t)p->of->n_loads + first, 1);
}

/* The subtree's part in both terms and in M V_0 of the rows beyond. */
static void add_subtree(const problem *p, const workspace *w, int i, int block) {
  const fem_condensed *c     = p->subtree[i];
  const int            count = width_of(p, block), first = block * WIDTH;
  const size_t         n = (size_t)count;
  fill_coordinates(p, c, block, w->q);
  add_flexibility(p, i, block, w->q, w->Qq);
  fem_lower_multiply(&c->Q, count, w->q, w->Qq);
  for (int a = 0; a < c->beyond; a++)
    cblas_daxpy(count, 1, w->Qq + (size_t)a * n, 1, top_row(p, w->Z, c->row[a], n), 1);
  for (int k = 0; k < c->loads; k++)
    cblas_daxpy(count, 1, w->Qq + (size_t)(c->beyond + k) * n, 1,
                p->R2 + (size_t)c->load[k] * (size_t)p->of->n_loads + first, 1);
  cblas_daxpy(p->of->modes * count, 1, w->Qq + (size_t)(c->beyond + c->loads) * n, 1, w->w, 1);
}

/* Both terms for a block of loads, as seen by the loads of this block and of those after it. */
static void finish_block(const problem *p, const workspace *w, int block) {
  const fem_unit_loads *of    = p->of;
  const int             count = width_of(p, block), first = block * WIDTH, modes = of->modes;
  const int             rows = of->n_loads - first;
  const size_t          n = (size_t)count, loads = (size_t)of->n_loads;
  const double         *V = p->V[block];
  for (int i = 0; i < p->n_top; i++)
    for (int e = p->entry[p->top_row[i]]; e < p->entry[p->top_row[i] + 1]; e++)
      cblas_daxpy(count, p->weight[e], V + (size_t)i * n, 1,
                  p->R + (size_t)p->load[e] * loads + first, 1);
  multiply_top(p, count, V, w->Z);
  memset(w->w, 0, (size_t)modes * n * sizeof *w->w);
  for (int i = 0; i < p->n_roots; i++) add_subtree(p, w, i, block);
  for (int i = block; i < p->n_blocks; i++)
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, width_of(p, i), count, p->n_top, 1,
                p->V[i], width_of(p, i), w->Z, count, 1,
                p->R2 + (size_t)(i * WIDTH) * loads + first, of->n_loads);
  if (modes == 0) return;
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, rows, count, modes, 1, p->part + first,
              of->n_loads, w->w, count, 1, p->R2 + (size_t)first * loads + first, of->n_loads);
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, modes, count, p->n_top, 1, p->top_phi, modes,
              w->Z, count, 0, p->trace + first, of->n_loads);
  for (int m = 0; m < modes; m++)
    cblas_daxpy(count, -1, w->w + (size_t)m * n, 1, p->trace + (size_t)m * loads + first, 1);
}

/* V_0 - phi g has no part in the modes, g the trace: R -= (b^T phi) g, R2 -= g^T g. */
static void remove_trace(problem *p) {
  const int n = p->of->n_loads, modes = p->of->modes;
  if (modes == 0) return;
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, n, n, modes, -1, p->trace, n, p->trace, n, 1,
              p->R2, n);
  for (int m = 0; m < modes; m++)
    cblas_dscal(n, p->of->lambda[m], p->part + (size_t)m * (size_t)n, 1);
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, n, n, modes, -1, p->part, n, p->trace, n, 1,
              p->R, n);
}

static void mirror(const problem *p) {
  const size_t n = (size_t)p->of->n_loads;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++) {
      p->R[j * n + i]  = p->R[i * n + j];
      p->R2[j * n + i] = p->R2[i * n + j];
    }
}

/* The calling thread asks whether to go on before each of its blocks.
 *   before  in  share of the blocks' work that is done */
static bool blocks_go_on(problem *p, double before, int block) {
  const double share = before + 0.5 * block / p->n_blocks;
  if (omp_get_thread_num() == 0) ask(p, SUBTREES + (1 - SUBTREES) * share);
  return !p->stopped;
}

static void run_blocks(problem *p) {
  const int  all = omp_get_max_threads(), most = all < p->n_blocks ? all : p->n_blocks;
  workspace *w = shb_alloc_zeroed((size_t)most + 1, sizeof *w);
  for (int i = 0; i < most; i++) create_workspace(p, &w[i]);
  const size_t n = (size_t)p->of->n_loads * (size_t)p->of->n_loads;
  memset(p->R, 0, n * sizeof *p->R);
  memset(p->R2, 0, n * sizeof *p->R2);
#pragma omp parallel num_threads(most)
  {
    const workspace *own = &w[omp_get_thread_num()];
#pragma omp for schedule(dynamic, 1)
    for (int i = 0; i < p->n_blocks; i++)
      if (blocks_go_on(p, 0, i)) solve_block(p, own, i);
#pragma omp for schedule(dynamic, 1)
    for (int i = 0; i < p->n_blocks; i++)
      if (blocks_go_on(p, 0.5, i)) finish_block(p, own, i);
  }
  for (int i = 0; i < most; i++) free_workspace(&w[i]);
  free(w);
}

static fem_loads_end solve(problem *p) {
  if (p->of->n_loads == 0) return FEM_LOADS_SOLVED;
  allocate(p);
  for (int i = 0; i < p->n / 3; i++) p->node[p->of->tree.place[i]] = i;
  cut(p);
  allocate_top(p);
  sort_entries(p);
  const fem_loads_end end = condense_subtrees(p);
  if (end != FEM_LOADS_SOLVED) return end;
  run_blocks(p);
  if (p->stopped) return FEM_LOADS_STOPPED;
  remove_trace(p);
  mirror(p);
  return FEM_LOADS_SOLVED;
}

fem_loads_end fem_unit_loads_solve(const fem_unit_loads *u, double *R, double *R2) {
  problem             p   = {.of = u, .n = u->tree.panels->n, .R = R, .R2 = R2};
  const fem_loads_end end = solve(&p);
  free_problem(&p);
  return end;
}
