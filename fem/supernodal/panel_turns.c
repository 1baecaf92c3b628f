#include "fem/supernodal/panel_turns.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* Panels that change a panel first are its children: lists by the number of a panel, -1 ends. */
typedef struct {
  const fem_supernodes    *s;
  const fem_lower_pattern *lower;
  const signed char       *exponent;
  fem_panel_turns         *out;
  int                     *child, *sibling; /* [n_panels] */
  int                     *owner;           /* [n/3] panel of a node */
  int                     *local;           /* [n/3] place of a node in the panel in work */
  int                     *root, *offset;   /* [most_rows/3] g_i = g_root + offset */
} search;

static int node_of(const fem_supernodes *s, const fem_panel *p, int i) {
  return fem_supernodes_row(s, p->row + 3 * (size_t)i) / 3;
}

static int find(const search *w, int i, int *offset) {
  for (*offset = 0; w->root[i] != i; i = w->root[i]) *offset += w->offset[i];
  return i;
}

/* Let g_a - g_b = e. false: it is another number already. */
static bool join(const search *w, int a, int b, int e) {
  int       of_a, of_b;
  const int x = find(w, a, &of_a), y = find(w, b, &of_b);
  if (x == y) return of_a - of_b == e;
  w->root[x]   = y;
  w->offset[x] = e + of_b - of_a;
  return true;
}

/* The rows of a real child beyond its columns are coupled to each other. */
static bool join_child(const search *w, int child) {
  const fem_panel   *p = &w->s->panel[child];
  const signed char *g = w->out->g + p->row / 3;
  const int          n = p->rows / 3, first = p->columns / 3;
  if (!w->out->is_real[child]) return false;
  for (int i = first + 1; i < n; i++)
    if (!join(w, w->local[node_of(w->s, p, i)], w->local[node_of(w->s, p, first)], g[i] - g[first]))
      return false;
  return true;
}

/* Blocks of A in the columns of a panel. */
static bool join_blocks(const search *w, const fem_panel *p) {
  for (int c = p->first / 3; c < (p->first + p->columns) / 3; c++)
    for (int k = w->lower->start[c]; k < w->lower->start[c + 1]; k++) {
      const int q = w->lower->block[k], e = (int)w->exponent[q < 0 ? ~q : q];
      if (e == FEM_ANY_BLOCK) return false;
      if (!join(w, w->local[w->lower->row[k]], w->local[c], q < 0 ? -e : e)) return false;
    }
  return true;
}

/* g of all rows of a panel, 0 at its first; false where one is too large. */
static bool store(const search *w, const fem_panel *p, signed char *g, bool *turns) {
  int base;
  find(w, 0, &base);
  for (int i = 0; i < p->rows / 3; i++) {
    int own;
    find(w, i, &own);
    own -= base;
    if (abs(own) > FEM_MOST_TURN) return false;
    g[i]   = (signed char)own;
    *turns = *turns || own != 0;
  }
  return true;
}

static void judge(const search *w, int k) {
  const fem_panel *p    = &w->s->panel[k];
  bool             real = true;
  for (int i = 0; i < p->rows / 3; i++) {
    w->local[node_of(w->s, p, i)] = w->root[i] = i;
    w->offset[i]                               = 0;
  }
  for (int c = w->child[k]; real && c >= 0; c = w->sibling[c]) real = join_child(w, c);
  real               = real && join_blocks(w, p);
  w->out->is_real[k] = real && store(w, p, w->out->g + p->row / 3, &w->out->turns[k]);
  w->out->turns[k]   = w->out->turns[k] && w->out->is_real[k];
  if (p->rows == p->columns) return;
  const int up  = w->owner[node_of(w->s, p, p->columns / 3)];
  w->sibling[k] = w->child[up];
  w->child[up]  = k;
}

static void allocate(search *w) {
  const size_t panels = (size_t)w->s->n_panels + 1, nodes = (size_t)w->s->n / 3 + 1;
  const size_t rows = (size_t)w->s->most_rows / 3 + 1;
  w->child          = shb_alloc(panels, sizeof(int));
  w->sibling        = shb_alloc(panels, sizeof(int));
  w->owner          = shb_alloc(nodes, sizeof(int));
  w->local          = shb_alloc(nodes, sizeof(int));
  w->root           = shb_alloc(rows, sizeof(int));
  w->offset         = shb_alloc(rows, sizeof(int));
  w->out->is_real   = shb_alloc_zeroed(panels, sizeof(bool));
  w->out->turns     = shb_alloc_zeroed(panels, sizeof(bool));
  w->out->g         = shb_alloc_zeroed(w->s->n_rows / 3 + 1, 1);
}

void fem_panel_turns_create(const fem_supernodes *s, const fem_lower_pattern *lower,
                            const signed char *exponent, fem_panel_turns *out) {
  search w = {.s = s, .lower = lower, .exponent = exponent, .out = out};
  allocate(&w);
  for (int k = 0; k < s->n_panels; k++) {
    w.child[k] = -1;
    for (int c = 0; c < s->panel[k].columns / 3; c++) w.owner[s->panel[k].first / 3 + c] = k;
  }
  for (int k = 0; k < s->n_panels; k++) judge(&w, k);
  free(w.child);
  free(w.sibling);
  free(w.owner);
  free(w.local);
  free(w.root);
  free(w.offset);
}

void fem_panel_turns_free(fem_panel_turns *turns) {
  free(turns->is_real);
  free(turns->turns);
  free(turns->g);
  *turns = (fem_panel_turns){0};
}
