#include "fem/supernodal/supernodes.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

enum { SHARES = 16 }; /* a subtree costs at most that part of the whole factorisation */

/* ------------------------------------------------------------------ panels */

/* A row or column of CHOLMOD's factor is a node with three dofs. */
enum { DOFS = 3 };

static int pieces_of(int columns) {
  return (columns + FEM_PANEL_COLUMNS - 1) / FEM_PANEL_COLUMNS;
}

static void allocate_panels(const cholmod_factor *L, fem_supernodes *out) {
  const int *super = L->super, *pi = L->pi;
  size_t     rows = 0;
  for (size_t s = 0; s < L->nsuper; s++) {
    const int pieces = pieces_of(DOFS * (super[s + 1] - super[s]));
    out->n_panels += pieces;
    rows += (size_t)pieces * DOFS * (size_t)(pi[s + 1] - pi[s]);
  }
  const size_t n = (size_t)out->n_panels;
  out->n         = DOFS * (int)L->n;
  out->panel     = shb_alloc(n + 1, sizeof *out->panel);
  out->row       = shb_alloc(rows + 1, sizeof *out->row);
  out->is_top    = shb_alloc_zeroed(n + 1, sizeof *out->is_top);
}

/* The rows of a panel that begins done rows below the first one of a supernode.
 *   node  in  [] of the supernode */
static void fill_rows(const int *node, int done, int rows, int *row) {
  for (int i = 0; i < rows; i++) row[i] = DOFS * node[(done + i) / DOFS] + (done + i) % DOFS;
}

/* Cut each supernode into panels of a multiple of 24 columns: nodes, and groups of eight. */
static void cut_panels(const cholmod_factor *L, fem_supernodes *out) {
  const int *super = L->super, *pi = L->pi, *node = L->s;
  fem_panel *p = out->panel;
  for (size_t s = 0; s < L->nsuper; s++) {
    const int all = DOFS * (super[s + 1] - super[s]), rows = DOFS * (pi[s + 1] - pi[s]);
    const int n = pieces_of(all), width = n > 1 ? ((all + n - 1) / n + 23) / 24 * 24 : all;
    for (int done = 0; done < all; done += width, p++) {
      p->first   = DOFS * super[s] + done;
      p->columns = all - done < width ? all - done : width;
      p->rows    = rows - done;
      p->row     = out->n_rows;
      p->value   = out->n_values;
      fill_rows(node + pi[s], done, p->rows, out->row + p->row);
      out->n_rows += (size_t)p->rows;
      out->n_values += (size_t)p->columns * (size_t)p->rows;
      if (p->rows > out->most_rows) out->most_rows = p->rows;
    }
  }
  out->n_panels = (int)(p - out->panel);
}

/* ------------------------------------------------------------------ updates */

static void fill_owners(const fem_supernodes *s, int *owner) {
  for (int k = 0; k < s->n_panels; k++)
    for (int c = 0; c < s->panel[k].columns; c++) owner[s->panel[k].first + c] = k;
}

/* One pass over the updates of all panels; without next they are counted in update_start. */
static void pass_updates(fem_supernodes *s, const int *owner, int *next) {
  for (int k = 0; k < s->n_panels; k++) {
    const fem_panel *p   = &s->panel[k];
    const int       *row = s->row + p->row;
    for (int begin = p->columns, end; begin < p->rows; begin = end) {
      const int to = owner[row[begin]];
      for (end = begin + 1; end < p->rows && owner[row[end]] == to;) end++;
      if (next)
        s->update[next[to]++] = (fem_update){k, begin, end};
      else
        s->update_start[to + 1]++;
    }
  }
}

static void list_updates(fem_supernodes *s, const int *owner) {
  const size_t n  = (size_t)s->n_panels;
  s->update_start = shb_alloc_zeroed(n + 1, sizeof(int));
  int *next       = shb_alloc(n + 1, sizeof(int));
  pass_updates(s, owner, NULL);
  for (size_t k = 0; k < n; k++) s->update_start[k + 1] += s->update_start[k];
  memcpy(next, s->update_start, (n + 1) * sizeof(int));
  s->update = shb_alloc((size_t)s->update_start[n] + 1, sizeof *s->update);
  pass_updates(s, owner, next);
  free(next);
}

/* ------------------------------------------------------------------ subtrees */

/* Of the subtree below each panel, with the panel. */
typedef struct {
  double *cost;
  int    *first, *size, *parent; /* parent -1: a root */
} tree;

static void climb(const fem_supernodes *s, const int *owner, tree *t) {
  for (int k = 0; k < s->n_panels; k++) t->first[k] = k;
  for (int k = 0; k < s->n_panels; k++) {
    const fem_panel *p = &s->panel[k];
    t->cost[k] += (double)p->columns * p->rows * p->rows;
    t->size[k]++;
    t->parent[k] = p->rows > p->columns ? owner[s->row[p->row + (size_t)p->columns]] : -1;
    const int up = t->parent[k];
    if (up < 0) continue;
    t->cost[up] += t->cost[k];
    t->size[up] += t->size[k];
    if (t->first[k] < t->first[up]) t->first[up] = t->first[k];
  }
}

/* A subtree must be a range of panels, as it is in a postorder. */
static bool may_be_subtree(const tree *t, int k, double limit) {
  return t->cost[k] <= limit && k - t->first[k] + 1 == t->size[k];
}

static int compare_cost(const void *a, const void *b) {
  const double *x = a, *y = b;
  return x[0] > y[0] ? -1 : x[0] < y[0] ? 1 : x[1] < y[1] ? -1 : x[1] > y[1];
}

/* roots [n_subtrees] (cost, panel), most costly first. */
static void take_roots(fem_supernodes *s, const tree *t, double (*roots)[2]) {
  double whole = 0;
  for (int k = 0; k < s->n_panels; k++) whole += t->parent[k] < 0 ? t->cost[k] : 0;
  for (int k = 0; k < s->n_panels; k++) s->is_top[k] = true;
  for (int k = s->n_panels - 1; k >= 0; k--) {
    if (!s->is_top[k] || !may_be_subtree(t, k, whole / SHARES)) continue;
    for (int i = t->first[k]; i <= k; i++) s->is_top[i] = false;
    roots[s->n_subtrees][0]   = t->cost[k];
    roots[s->n_subtrees++][1] = k;
  }
  qsort(roots, (size_t)s->n_subtrees, sizeof *roots, compare_cost);
}

/* Let the rows of a subtree beyond its columns point to its copies. */
static void point_to_copies(fem_supernodes *s, const fem_subtree *t, const int *own) {
  for (int k = t->first; k < t->last; k++) {
    const fem_panel *p   = &s->panel[k];
    int             *row = s->row + p->row;
    const int        end = s->panel[t->last - 1].first + s->panel[t->last - 1].columns;
    int              at  = 0;
    for (int i = 0; i < p->rows; i++) {
      if (row[i] < end) continue;
      while (own[at] < row[i]) at++;
      row[i] = t->copy + at;
    }
  }
}

static void place_copies(fem_supernodes *s, const tree *t, double (*roots)[2]) {
  s->n_extended = s->n;
  s->subtree    = shb_alloc((size_t)s->n_subtrees + 1, sizeof *s->subtree);
  for (int i = 0; i < s->n_subtrees; i++) {
    const int        k    = (int)roots[i][1];
    const fem_panel *root = &s->panel[k];
    s->subtree[i] = (fem_subtree){t->first[k], k + 1, s->n_extended, root->rows - root->columns};
    s->n_extended += s->subtree[i].n_copies;
  }
  s->original = shb_alloc((size_t)(s->n_extended - s->n) + 1, sizeof(int));
  for (int i = 0; i < s->n_subtrees; i++) {
    const fem_subtree *sub  = &s->subtree[i];
    const fem_panel   *root = &s->panel[sub->last - 1];
    int               *own  = s->original + (sub->copy - s->n);
    memcpy(own, s->row + root->row + root->columns, (size_t)sub->n_copies * sizeof(int));
    point_to_copies(s, sub, own);
  }
}

static void find_subtrees(fem_supernodes *s, const int *owner) {
  const size_t n    = (size_t)s->n_panels;
  tree         t    = {shb_alloc_zeroed(n + 1, sizeof(double)), shb_alloc(n + 1, sizeof(int)),
                       shb_alloc_zeroed(n + 1, sizeof(int)), shb_alloc(n + 1, sizeof(int))};
  double(*roots)[2] = shb_alloc(n + 1, sizeof *roots);
  climb(s, owner, &t);
  take_roots(s, &t, roots);
  place_copies(s, &t, roots);
  free(t.cost);
  free(t.first);
  free(t.size);
  free(t.parent);
  free(roots);
}

void fem_supernodes_create(const cholmod_factor *L, fem_supernodes *out) {
  memset(out, 0, sizeof *out);
  int *owner = shb_alloc(DOFS * L->n + 1, sizeof *owner);
  allocate_panels(L, out);
  cut_panels(L, out);
  fill_owners(out, owner);
  list_updates(out, owner);
  find_subtrees(out, owner);
  free(owner);
}

void fem_supernodes_needed(const fem_supernodes *s, bool *row, bool *needed) {
  for (int k = 0; k < s->n_panels; k++) {
    const fem_panel *p = &s->panel[k];
    needed[k]          = false;
    for (int c = 0; c < p->columns; c++) needed[k] = needed[k] || row[p->first + c];
    if (needed[k] && p->rows > p->columns)
      row[fem_supernodes_row(s, p->row + (size_t)p->columns)] = true;
  }
}

void fem_supernodes_free(fem_supernodes *s) {
  free(s->panel);
  free(s->row);
  free(s->original);
  free(s->update);
  free(s->update_start);
  free(s->subtree);
  free(s->is_top);
  memset(s, 0, sizeof *s);
}
