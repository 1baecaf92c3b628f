#include "fem/supernodal/condensed_mass.h"

#include <cblas.h>
#include <stdlib.h>
#include <string.h>

#include "fem/supernodal/hot.h"
#include "fem/supernodal/large_pages.h"
#include "fem/supernodal/supernodal_solve.h"
#include "mesh/base/memory.h"

/* LEAF: columns of a small subtree, at most, that is condensed in one step. CHUNK: numbers of a row
 * that are summed in registers. SHARE: coordinates that a thread takes at once. */
enum { LEAF = 240, CHUNK = 32, SHARE = 256, NOWHERE = -1 };

static const double MANY = 1e7; /* multiplications that are worth several threads */

/* What is left of a subtree while panels above it are eliminated. Its arrays lie on a stack. */
typedef struct part part;
struct part {
  fem_condensed of;         /* its pointers hold during a step */
  size_t        Q, U, F;    /* where they begin */
  size_t        begin, end; /* what the part takes of the stack */
  part         *next;
};

/* A step of the elimination: a small subtree, or one panel. */
typedef struct {
  int     first, last; /* panels first .. last - 1 */
  int     first_row, rows;
  part   *to;
  bool    goes_on; /* with the arrays of its first part below */
  double *y;       /* [rows + beyond][loads] the loads, solved forward */
  double *E;       /* [rows + beyond][size] motion of its rows by coordinates, and scratch */
  double *Z;       /* [rows][size] */
  double *own;     /* [rows][rows] mass of the parts below among its rows */
  double *work;
  size_t  y_at, E_at, Z_at, own_at, work_at; /* where they begin on the stack */
} step;

/* What a subtree's steps share. */
typedef struct {
  const fem_loaded_body *body;
  int                    root_first;
  part                 **child;     /* [panels of the subtree] parts that end in a panel */
  int                   *local;     /* [n / 3] index of a node in the step, or NOWHERE */
  int                   *place;     /* [n_loads] index of a load in the step, or NOWHERE */
  int                   *at;        /* [most_rows] */
  int                   *column;    /* [nodes in a row of M] */
  double                *mass;      /* the same */
  double                *stack;     /* NULL: steps are only counted */
  size_t                 top, most; /* numbers on it now; the most that a step needs */
} workspace;

/* ------------------------------------------------------------------ memory of the parts */

/* So many numbers from a place on, which moves behind them. */
static size_t carve(size_t *at, size_t numbers) {
  const size_t line = 8, from = *at;
  *at += (numbers + line - 1) / line * line;
  return from;
}

static void set_pointers(const workspace *w, part *p) {
  p->of.Q.at = w->stack + p->Q;
  p->of.U    = w->stack + p->U;
  p->of.F    = w->stack + p->F;
}

static void free_part(part *p) {
  if (!p) return;
  free(p->of.row);
  free(p->of.load);
  free(p);
}

static void free_parts(part *p) {
  while (p) {
    part *next = p->next;
    free_part(p);
    p = next;
  }
}

void fem_condensed_free(fem_condensed *c) {
  if (!c) return;
  free(c->row);
  free(c->load);
  free(c->Q.at);
  free(c->U);
  free(c->F);
  free(c);
}

/* Room for the matrices of the last part, whose coordinates are taken over. */
static fem_condensed *make_room(part *last) {
  fem_condensed *c = shb_alloc(1, sizeof *c);
  *c               = last->of;
  const size_t b = (size_t)c->beyond, l = (size_t)c->loads;
  c->Q = (fem_lower){shb_alloc(fem_lower_numbers(c->size) + 1, sizeof *c->Q.at), c->size, 0};
  c->U = shb_alloc(b * l + 1, sizeof *c->U);
  c->F = shb_alloc(l * l + 1, sizeof *c->F);
  last->of.row = last->of.load = NULL;
  return c;
}

static void copy_matrices(const part *last, fem_condensed *to) {
  const size_t n = (size_t)to->size, b = (size_t)to->beyond, l = (size_t)to->loads;
  memcpy(to->U, last->of.U, b * l * sizeof *to->U);
  memcpy(to->F, last->of.F, l * l * sizeof *to->F);
  for (size_t j = 0; j < n; j++)
    memcpy(fem_lower_column(&to->Q, (int)j) + j, fem_lower_column(&last->of.Q, (int)j) + j,
           (n - j) * sizeof *to->Q.at);
}

/* ------------------------------------------------------------------ begin and end of a step */

static int compare_ints(const void *a, const void *b) {
  const int *x = a, *y = b;
  return (*x > *y) - (*x < *y);
}

static void list_load(workspace *w, fem_condensed *to, int load) {
  if (w->place[load] != NOWHERE) return;
  w->place[load]        = 0;
  to->load[to->loads++] = load;
}

/* Loads of the step's rows and of the parts below. */
static void list_loads(workspace *w, const step *s, const part *child) {
  const fem_loaded_body *b    = w->body;
  fem_condensed         *to   = &s->to->of;
  const int              from = b->entry[s->first_row], end = b->entry[s->first_row + s->rows];
  int                    most = end - from;
  for (const part *c = child; c; c = c->next) most += c->of.loads;
  to->load = shb_alloc((size_t)most + 1, sizeof *to->load);
  for (int e = from; e < end; e++) list_load(w, to, b->load[e]);
  for (const part *c = child; c; c = c->next)
    for (int i = 0; i < c->of.loads; i++) list_load(w, to, c->of.load[i]);
  qsort(to->load, (size_t)to->loads, sizeof *to->load, compare_ints);
  for (int i = 0; i < to->loads; i++) w->place[to->load[i]] = i;
}

/* The part that the step leaves, and where its nodes and loads stand in it. */
static void begin(workspace *w, step *s, const part *child) {
  const fem_supernodes *p    = w->body->panels;
  const fem_panel      *last = &p->panel[s->last - 1];
  s->to                      = shb_alloc_zeroed(1, sizeof *s->to);
  fem_condensed *to          = &s->to->of;
  s->first_row               = p->panel[s->first].first;
  s->rows                    = last->first + last->columns - s->first_row;
  to->beyond                 = last->rows - last->columns;
  to->row                    = shb_alloc((size_t)to->beyond + 1, sizeof *to->row);
  for (int i = 0; i < to->beyond; i++)
    to->row[i] = fem_supernodes_row(p, last->row + (size_t)(last->columns + i));
  list_loads(w, s, child);
  to->size = to->beyond + to->loads + w->body->modes;
  for (int i = 0; i < s->rows / 3; i++) w->local[s->first_row / 3 + i] = i;
  for (int i = 0; i < to->beyond / 3; i++) w->local[to->row[3 * i] / 3] = s->rows / 3 + i;
}

static void end(workspace *w, step *s) {
  const fem_condensed *to = &s->to->of;
  for (int i = 0; i < s->rows / 3; i++) w->local[s->first_row / 3 + i] = NOWHERE;
  for (int i = 0; i < to->beyond / 3; i++) w->local[to->row[3 * i] / 3] = NOWHERE;
  for (int i = 0; i < to->loads; i++) w->place[to->load[i]] = NOWHERE;
}

/* The part below whose arrays the step goes on with comes first. Its coordinates are the step's
 * rows and coordinates. */
static bool goes_on(const step *s, const part *c) {
  return c->of.size == s->rows + s->to->of.size && c->of.beyond == s->rows + s->to->of.beyond;
}

static part *put_first(const step *s, part *child) {
  for (part **at = &child; *at; at = &(*at)->next)
    if (goes_on(s, *at)) {
      part *found = *at;
      *at         = found->next;
      found->next = child;
      return found;
    }
  return child;
}

/* Places of the step's arrays: on top of the stack, or those of the first part below. */
static void place_arrays(workspace *w, step *s, const part *child) {
  fem_condensed *to = &s->to->of;
  const size_t   n = (size_t)to->size, rows = (size_t)s->rows, b = (size_t)to->beyond;
  const size_t   c = (size_t)to->loads, modes = (size_t)w->body->modes;
  const bool     one = s->last - s->first == 1;
  size_t         at  = w->top;
  s->goes_on         = child && goes_on(s, child);
  if (s->goes_on) {
    to->Q    = (fem_lower){NULL, child->of.Q.n, child->of.Q.skip + s->rows};
    s->to->Q = child->Q;
    s->y_at  = child->U;
    s->to->F = child->F;
  } else {
    to->Q    = (fem_lower){NULL, to->size, 0};
    s->to->Q = carve(&at, fem_lower_numbers(to->size));
    s->y_at  = carve(&at, (rows + b) * c);
    s->to->F = carve(&at, c * c);
  }
  s->to->U   = s->y_at + rows * c;
  s->E_at    = carve(&at, rows * n + b * (one ? modes : n));
  s->Z_at    = carve(&at, rows * n);
  s->own_at  = carve(&at, rows * rows);
  s->work_at = carve(&at, (rows + b) * (one ? c : n));
  if (at > w->most) w->most = at;
}

/* New arrays are filled with zeros. */
static void open_arrays(const workspace *w, step *s, part *child) {
  fem_condensed *to = &s->to->of;
  const size_t   c = (size_t)to->loads, all = (size_t)s->rows + (size_t)to->beyond;
  s->y    = w->stack + s->y_at;
  s->E    = w->stack + s->E_at;
  s->Z    = w->stack + s->Z_at;
  s->own  = w->stack + s->own_at;
  s->work = w->stack + s->work_at;
  set_pointers(w, s->to);
  for (part *p = child; p; p = p->next) set_pointers(w, p);
  if (s->goes_on) return;
  memset(to->Q.at, 0, fem_lower_numbers(to->size) * sizeof *to->Q.at);
  memset(s->y, 0, all * c * sizeof *s->y);
  memset(to->F, 0, c * c * sizeof *to->F);
}

static size_t move(const workspace *w, size_t from, size_t numbers, size_t *at) {
  const size_t to = carve(at, numbers);
  if (w->stack) memmove(w->stack + to, w->stack + from, numbers * sizeof *w->stack);
  return to;
}

/* The step's arrays take the place of the parts below. */
static void settle(workspace *w, const step *s, const part *child) {
  const size_t b = (size_t)s->to->of.beyond, c = (size_t)s->to->of.loads;
  part        *to = s->to;
  to->begin       = w->top;
  for (const part *p = child; p; p = p->next)
    if (p->begin < to->begin) to->begin = p->begin;
  if (s->goes_on) {
    to->end = child->end;
  } else {
    to->end = to->begin;
    to->Q   = move(w, to->Q, fem_lower_numbers(to->of.size), &to->end);
    to->U   = move(w, to->U, b * c, &to->end);
    to->F   = move(w, to->F, c * c, &to->end);
  }
  w->top = to->end;
}

/* ------------------------------------------------------------------ motion of the rows */

/* Row of the factor in the step: own rows, then those beyond. */
static int in_step(const workspace *w, int row) {
  return 3 * w->local[row / 3] + row % 3;
}

static void place_rows(const workspace *w, const fem_panel *p) {
  for (int i = p->columns; i < p->rows; i++)
    w->at[i - p->columns] = in_step(w, fem_supernodes_row(w->body->panels, p->row + (size_t)i));
}

/* Forward solution with one panel. */
static void forward_panel(const fem_loaded_body *b, const step *s) {
  const fem_panel *p = &b->panels->panel[s->first];
  const double    *L = b->value + p->value;
  const int        c = s->to->of.loads, below = p->rows - p->columns;
#pragma omp parallel for schedule(dynamic, 1) if ((double)c * below * p->columns > MANY)
  for (int from = 0; from < c; from += SHARE) {
    const int count = c - from < SHARE ? c - from : SHARE;
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, count, p->columns,
                1, L, p->rows, s->y + from, c);
    if (below > 0)
      cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, count, below, p->columns, -1,
                  s->y + from, c, L + p->columns, p->rows, 1,
                  s->y + (size_t)p->columns * (size_t)c + from, c);
  }
}

/* The loads of the step's rows and of the parts below, solved forward. They leave U in place. */
static void forward_loads(const workspace *w, const step *s, const part *child) {
  const fem_loaded_body *b = w->body;
  const size_t           c = (size_t)s->to->of.loads;
  if (c == 0) return;
  for (int r = 0; r < s->rows; r++)
    for (int e = b->entry[s->first_row + r]; e < b->entry[s->first_row + r + 1]; e++)
      s->y[(size_t)r * c + (size_t)w->place[b->load[e]]] += b->weight[e];
  if (s->goes_on) child = child->next;
  for (; child; child = child->next)
    for (int i = 0; i < child->of.beyond; i++)
      for (int j = 0; j < child->of.loads; j++)
        s->y[(size_t)in_step(w, child->of.row[i]) * c + (size_t)w->place[child->of.load[j]]] +=
            child->of.U[(size_t)i * (size_t)child->of.loads + (size_t)j];
  if (s->last - s->first == 1) {
    forward_panel(b, s);
    return;
  }
  for (int k = s->first; k < s->last; k++) {
    const fem_panel *p = &b->panels->panel[k];
    place_rows(w, p);
    fem_panel_forward(p, b->value + p->value, w->at, (int)c,
                      s->y + (size_t)(p->first - s->first_row) * c, s->y, s->work);
  }
}

/* F += y^T y, and that of the parts below. */
static void add_flexibility(const workspace *w, const step *s, const part *child) {
  const int    c = s->to->of.loads;
  const size_t n = (size_t)c;
  double      *F = s->to->of.F;
  if (c == 0) return;
#pragma omp parallel for schedule(dynamic, 1) if ((double)c * c * s->rows > MANY)
  for (int from = 0; from < c; from += SHARE)
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, c, c - from < SHARE ? c - from : SHARE,
                s->rows, 1, s->y, c, s->y + from, c, 1, F + from, c);
  if (s->goes_on) child = child->next;
  for (; child; child = child->next)
    for (int i = 0; i < child->of.loads; i++)
      for (int j = 0; j < child->of.loads; j++)
        F[(size_t)w->place[child->of.load[i]] * n + (size_t)w->place[child->of.load[j]]] +=
            child->of.F[(size_t)i * (size_t)child->of.loads + (size_t)j];
}

/* E q is the motion of the rows. It follows from L^T x = y with the rows beyond given; the modes
 * move the rows beyond by phi, and phi is taken off. */
static void solve_motion(const workspace *w, const step *s) {
  const fem_loaded_body *b  = w->body;
  const fem_condensed   *to = &s->to->of;
  const size_t           n = (size_t)to->size, c = (size_t)to->loads, modes = (size_t)b->modes;
  const size_t           own = (size_t)s->rows, beyond = (size_t)to->beyond;
  memset(s->E, 0, (own + beyond) * n * sizeof *s->E);
  for (size_t r = 0; r < own && c > 0; r++)
    memcpy(s->E + r * n + beyond, s->y + r * c, c * sizeof *s->y);
  for (size_t i = 0; i < beyond; i++) {
    double *row = s->E + (own + i) * n;
    row[i]      = 1;
    memcpy(row + beyond + c, b->phi + (size_t)to->row[i] * modes, modes * sizeof *row);
  }
  for (int k = s->last; k-- > s->first;) {
    const fem_panel *p = &b->panels->panel[k];
    place_rows(w, p);
    fem_panel_backward(p, b->value + p->value, w->at, to->size,
                       s->E + (size_t)(p->first - s->first_row) * n, s->E, s->work);
  }
}

/* The right-hand side of that for one panel, whose rows beyond move by the unit matrix. */
static void begin_motion(const workspace *w, const step *s) {
  const fem_loaded_body *b  = w->body;
  const fem_panel       *p  = &b->panels->panel[s->first];
  const double          *L  = b->value + p->value;
  const fem_condensed   *to = &s->to->of;
  const int              n = to->size, modes = b->modes;
  const size_t           c = (size_t)to->loads, own = (size_t)s->rows, beyond = (size_t)to->beyond;
  double                *phi = s->E + own * (size_t)n; /* [beyond][modes] */
  for (size_t i = 0; i < beyond; i++)
    memcpy(phi + i * (size_t)modes, b->phi + (size_t)to->row[i] * (size_t)modes,
           (size_t)modes * sizeof *phi);
  for (size_t r = 0; r < own; r++) {
    double *row = s->E + r * (size_t)n;
    for (size_t i = 0; i < beyond; i++) row[i] = -L[r * (size_t)p->rows + own + i];
    if (c > 0) memcpy(row + beyond, s->y + r * c, c * sizeof *s->y);
    memset(row + beyond + c, 0, (size_t)modes * sizeof *row);
  }
  if (beyond > 0 && modes > 0)
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, s->rows, modes, (int)beyond, 1, s->E, n,
                phi, modes, 0, s->E + beyond + c, n);
}

/* E -= phi at the modes among the coordinates from .. from + count - 1. */
static void take_modes_off(const workspace *w, const step *s, int from, int count) {
  const int     n = s->to->of.size, modes = w->body->modes, first = n - modes;
  const int     begin = from > first ? from : first, end = from + count;
  const double *phi = w->body->phi + (size_t)s->first_row * (size_t)modes;
  for (size_t r = 0; r < (size_t)s->rows; r++)
    for (int j = begin; j < end; j++)
      s->E[r * (size_t)n + (size_t)j] -= phi[r * (size_t)modes + (size_t)(j - first)];
}

/* ------------------------------------------------------------------ mass */

/* y += sum of m_i x_i, rows of so many numbers. */
FEM_HOT static void sum_rows(int n, const int *at, const double *m, const double *x, size_t length,
                             double *y) {
  size_t j = 0;
  for (; j + CHUNK <= length; j += CHUNK) {
    double sum[CHUNK];
    memcpy(sum, y + j, sizeof sum);
    for (int i = 0; i < n; i++) {
      const double *from = x + (size_t)at[i] * length + j;
      for (int c = 0; c < CHUNK; c++) sum[c] += m[i] * from[c];
    }
    memcpy(y + j, sum, sizeof sum);
  }
  for (; j < length; j++) {
    for (int i = 0; i < n; i++) y[j] += m[i] * x[(size_t)at[i] * length + j];
  }
}

/* Z += M_SS E + 2 M_Sa: the masses of the rows S, among each other and with the rows a beyond. */
static void add_mass(const workspace *w, const step *s) {
  const fem_loaded_body *b   = w->body;
  const int              own = s->rows / 3;
  const size_t           n   = (size_t)s->to->of.size;
  for (int i = 0; i < own; i++) {
    const int node  = b->node[s->first_row / 3 + i];
    double   *Z     = s->Z + 3 * (size_t)i * n;
    int       count = 0;
    for (int k = b->start[node]; k < b->start[node + 1]; k++) {
      const int at = w->local[b->place[b->column[k]]];
      if (at < 0 || at >= own) continue;
      w->column[count] = at;
      w->mass[count++] = b->mass[k];
    }
    sum_rows(count, w->column, w->mass, s->E, 3 * n, Z);
    for (int k = b->start[node]; k < b->start[node + 1]; k++) {
      const int at = w->local[b->place[b->column[k]]];
      if (at < own) continue;
      for (size_t d = 0; d < 3; d++) Z[d * n + 3 * (size_t)(at - own) + d] += 2 * b->mass[k];
    }
  }
}

/* Coordinates from .. from + count - 1 of a part below are those from to on. */
typedef struct {
  int from, to, count;
} run;

static int append_run(run *runs, int n, int from, int to) {
  if (n > 0 && runs[n - 1].from + runs[n - 1].count == from &&
      runs[n - 1].to + runs[n - 1].count == to) {
    runs[n - 1].count++;
    return n;
  }
  runs[n] = (run){from, to, 1};
  return n + 1;
}

/* Where the coordinates of a part below stand in the step: the first own in its rows, the others
 * among its coordinates. */
static int list_runs(const workspace *w, const step *s, const fem_condensed *c, int *own,
                     run *runs) {
  const fem_condensed *to = &s->to->of;
  int                  n  = 0;
  for (*own = 0; *own < c->beyond && in_step(w, c->row[*own]) < s->rows;) ++*own;
  for (int i = *own; i < c->beyond; i++)
    n = append_run(runs, n, i, in_step(w, c->row[i]) - s->rows);
  for (int i = 0; i < c->loads; i++)
    n = append_run(runs, n, c->beyond + i, to->beyond + w->place[c->load[i]]);
  for (int i = 0; i < w->body->modes; i++)
    n = append_run(runs, n, c->beyond + c->loads + i, to->beyond + to->loads + i);
  return n;
}

/* Take the condensed mass of a part below: among the step's rows to own [rows][rows], between them
 * and the coordinates to Z. */
static void add_own(const workspace *w, const step *s, const part *c, int n_own, const run *runs,
                    int n) {
  const size_t to = (size_t)s->to->of.size, rows = (size_t)s->rows;
  for (int j = 0; j < n_own; j++) {
    const double *column = fem_lower_column(&c->of.Q, j);
    const size_t  a      = (size_t)in_step(w, c->of.row[j]);
    for (int i = j; i < n_own; i++) {
      const size_t b = (size_t)in_step(w, c->of.row[i]);
      s->own[b * rows + a] += column[i];
      if (i > j) s->own[a * rows + b] += column[i];
    }
    for (int r = 0; r < n; r++)
      for (int i = 0; i < runs[r].count; i++)
        s->Z[a * to + (size_t)(runs[r].to + i)] += 2 * column[runs[r].from + i];
  }
}

/* Q += that among the other coordinates. */
static void add_others(const step *s, const part *c, const run *runs, int n) {
  for (int q = 0; q < n; q++)
    for (int j = 0; j < runs[q].count; j++) {
      const double *column = fem_lower_column(&c->of.Q, runs[q].from + j);
      double       *Q      = fem_lower_column(&s->to->of.Q, runs[q].to + j);
      for (int i = j; i < runs[q].count; i++) Q[runs[q].to + i] += column[runs[q].from + i];
      for (int r = q + 1; r < n; r++)
        for (int i = 0; i < runs[r].count; i++) Q[runs[r].to + i] += column[runs[r].from + i];
    }
}

/* Q and Z += the mass of the parts below, but for that among the step's rows. */
static void add_parts(const workspace *w, const step *s, const part *child) {
  int longest = 0;
  memset(s->Z, 0, (size_t)s->rows * (size_t)s->to->of.size * sizeof *s->Z);
  memset(s->own, 0, (size_t)s->rows * (size_t)s->rows * sizeof *s->own);
  for (const part *c = child; c; c = c->next)
    if (c->of.size > longest) longest = c->of.size;
  run *runs = shb_alloc((size_t)longest + 1, sizeof *runs);
  for (const part *c = child; c; c = c->next) {
    int       n_own;
    const int n_runs = list_runs(w, s, &c->of, &n_own, runs);
    add_own(w, s, c, n_own, runs, n_runs);
    if (!s->goes_on || c != child) add_others(s, c, runs, n_runs);
  }
  free(runs);
}

/* Solve L^T E = E, then Z += own E. */
static void finish_motion(const workspace *w, const step *s) {
  const fem_panel *p = &w->body->panels->panel[s->first];
  const double    *L = w->body->value + p->value;
  const int        n = s->to->of.size, rows = s->rows;
#pragma omp parallel for schedule(dynamic, 1) if ((double)n * rows * rows > MANY)
  for (int from = 0; from < n; from += SHARE) {
    const int count = n - from < SHARE ? n - from : SHARE;
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasNoTrans, CblasNonUnit, count, rows, 1,
                L, p->rows, s->E + from, n);
    take_modes_off(w, s, from, count);
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, rows, count, rows, 1, s->own, rows,
                s->E + from, n, 1, s->Z + from, n);
  }
}

/* ------------------------------------------------------------------ steps */

/* Q += (E^T Z + Z^T E) / 2, Z = M_SS E + 2 M_Sa with the parts below. */
static void run_step(const workspace *w, const step *s, const part *child) {
  forward_loads(w, s, child);
  add_flexibility(w, s, child);
  add_parts(w, s, child);
  if (s->last - s->first == 1) {
    begin_motion(w, s);
    finish_motion(w, s);
  } else {
    solve_motion(w, s);
    take_modes_off(w, s, 0, s->to->of.size);
  }
  add_mass(w, s);
  fem_lower_add_products(&s->to->of.Q, s->rows, s->E, s->Z);
}

/* Eliminate the rows of a step. Returns the part that is left. */
static part *take_step(workspace *w, int first, int last) {
  part **list = &w->child[last - 1 - w->root_first];
  step   s    = {.first = first, .last = last};
  begin(w, &s, *list);
  *list = put_first(&s, *list);
  place_arrays(w, &s, *list);
  if (w->stack) {
    open_arrays(w, &s, *list);
    run_step(w, &s, *list);
  }
  settle(w, &s, *list);
  end(w, &s);
  free_parts(*list);
  *list = NULL;
  return s.to;
}

static void create_workspace(workspace *w, int panels) {
  const fem_loaded_body *b       = w->body;
  const int              nodes   = b->panels->n / 3;
  int                    longest = 0;
  for (int i = 0; i < nodes; i++)
    if (b->start[i + 1] - b->start[i] > longest) longest = b->start[i + 1] - b->start[i];
  w->child  = shb_alloc_zeroed((size_t)panels + 1, sizeof(part *));
  w->local  = shb_alloc((size_t)nodes + 1, sizeof *w->local);
  w->place  = shb_alloc((size_t)b->n_loads + 1, sizeof *w->place);
  w->at     = shb_alloc((size_t)b->panels->most_rows + 1, sizeof *w->at);
  w->column = shb_alloc((size_t)longest + 1, sizeof *w->column);
  w->mass   = shb_alloc((size_t)longest + 1, sizeof *w->mass);
  for (int i = 0; i < nodes; i++) w->local[i] = NOWHERE;
  for (int i = 0; i < b->n_loads; i++) w->place[i] = NOWHERE;
}

static void free_workspace(workspace *w, int panels) {
  for (int i = 0; i < panels; i++) free_parts(w->child[i]);
  free(w->child);
  free(w->local);
  free(w->place);
  free(w->at);
  free(w->column);
  free(w->mass);
}

/* Is the subtree below panel i small, and does it begin with panel first? */
static bool is_leaf(const fem_loaded_body *b, int first, int i) {
  const fem_panel *p = b->panels->panel;
  return b->below[i] == first && p[i].first + p[i].columns - p[first].first <= LEAF;
}

/* The end of the greatest small subtree that begins with a panel; else that of the panel. */
static int end_of_step(const fem_loaded_body *b, int first, int root) {
  int end = first + 1;
  for (int i = first; i <= root && b->panels->panel[i].first - b->panels->panel[first].first < LEAF;
       i++)
    if (is_leaf(b, first, i)) end = i + 1;
  return end;
}

static double done_before(const fem_loaded_body *b, int panel) {
  return (double)b->panels->panel[panel].first / b->panels->n;
}

/* Returns the last part; NULL where go_on says so. */
static part *take_steps(workspace *w, int root) {
  const int first = w->root_first;
  part     *left  = NULL;
  w->top          = 0;
  for (int k = first; k <= root;) {
    const int last = end_of_step(w->body, k, root);
    if (w->stack && !w->body->go_on(w->body->context, done_before(w->body, k))) return NULL;
    left = take_step(w, k, last);
    if (last <= root) {
      part **list = &w->child[w->body->owner[left->of.row[0]] - first];
      left->next  = *list;
      *list       = left;
    }
    k = last;
  }
  return left;
}

/* All steps of a subtree, with their workspace. */
static part *eliminate(const fem_loaded_body *body, int root, workspace *w) {
  const int panels = root + 1 - body->below[root];
  create_workspace(w, panels);
  part *last = take_steps(w, root);
  free_workspace(w, panels);
  return last;
}

fem_condensed *fem_condensed_create(const fem_loaded_body *body, int root, size_t *stack) {
  workspace      w    = {.body = body, .root_first = body->below[root]};
  part          *last = eliminate(body, root, &w);
  fem_condensed *room = make_room(last);
  *stack              = w.most;
  free_part(last);
  return room;
}

bool fem_condense(const fem_loaded_body *body, int root, double *stack, fem_condensed *to) {
  workspace w    = {.body = body, .root_first = body->below[root], .stack = stack};
  part     *last = eliminate(body, root, &w);
  if (!last) return false;
  set_pointers(&w, last);
  copy_matrices(last, to);
  free_part(last);
  return true;
}
