#include "fem/supernodal/coarse_order.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* SMALLEST: nodes of a part that is not dissected further. FEWER: the nodes must be so many times
 * those that are dissected. */
enum { SMALLEST = 10, FEWER = 2 };

/* Neighbours of each node, without itself. */
typedef struct {
  int  n;
  int *start, *node; /* [n + 1], [start[n]] */
} neighbours;

/* Parts and separators, each with the separator that cuts it off; children come before parents, and
 * the sets below one are a range. */
typedef struct {
  int *parent; /* -1: a root */
  int *first;  /* least set below each one */
} separators;

/* ------------------------------------------------------------------ neighbours */

static void list_neighbours(const cholmod_sparse *graph, neighbours *out) {
  const int   *start = graph->p, *column = graph->i;
  const size_t n = graph->ncol, most = 2 * (size_t)start[n];
  int         *next;
  out->n     = (int)n;
  out->start = shb_alloc_zeroed(n + 1, sizeof(int));
  out->node  = shb_alloc(most + 1, sizeof(int));
  next       = shb_alloc(n + 1, sizeof(int));
  for (int pass = 0; pass < 2; pass++) {
    for (int r = 0; r < out->n; r++)
      for (int k = start[r]; k < start[r + 1]; k++) {
        const int c = column[k];
        if (c == r) continue;
        if (pass == 0) {
          out->start[r + 1]++, out->start[c + 1]++;
          continue;
        }
        out->node[next[r]++] = c;
        out->node[next[c]++] = r;
      }
    for (size_t r = 0; pass == 0 && r < n; r++) out->start[r + 1] += out->start[r];
    memcpy(next, out->start, (n + 1) * sizeof(int));
  }
  free(next);
}

static void free_neighbours(neighbours *g) {
  free(g->start);
  free(g->node);
}

static int count_of(const neighbours *g, int i) {
  return g->start[i + 1] - g->start[i];
}

/* ------------------------------------------------------------------ domination */

/* Is every neighbour of i marked by a? */
static bool all_marked(const neighbours *g, int i, const int *mark, int a) {
  for (int k = g->start[i]; k < g->start[i + 1]; k++)
    if (mark[g->node[k]] != a + 1) return false;
  return true;
}

/* Mark the nodes that a dominates. Of nodes with the same neighbours the first dominates.
 *   mark  in/out  [n] 1 + the last node whose neighbour this one was */
static void dominate(const neighbours *g, int a, int *mark, bool *dominated) {
  mark[a] = a + 1;
  for (int k = g->start[a]; k < g->start[a + 1]; k++) mark[g->node[k]] = a + 1;
  for (int k = g->start[a]; k < g->start[a + 1]; k++) {
    const int  i = g->node[k], more = count_of(g, a) - count_of(g, i);
    const bool may = !dominated[i] && (more > 0 || (more == 0 && i > a));
    if (may && all_marked(g, i, mark, a)) dominated[i] = true;
  }
}

/* number [n] of the nodes that nobody dominates, -1 for the others. Returns how many. */
static int number_kept(const neighbours *g, int *number) {
  const size_t n    = (size_t)g->n;
  int         *mark = shb_alloc_zeroed(n + 1, sizeof *mark), kept = 0;
  bool        *dominated = shb_alloc_zeroed(n + 1, sizeof *dominated);
  for (int a = 0; a < g->n; a++)
    if (!dominated[a]) dominate(g, a, mark, dominated);
  for (int i = 0; i < g->n; i++) number[i] = dominated[i] ? -1 : kept++;
  free(mark);
  free(dominated);
  return kept;
}

/* ------------------------------------------------------------------ dissection */

/* The graph of the kept nodes, lower triangle by columns. */
static cholmod_sparse *kept_graph(const neighbours *g, const int *number, int kept,
                                  cholmod_common *common) {
  const size_t    n = (size_t)kept, most = n + (size_t)g->start[g->n] / 2;
  cholmod_sparse *out = cholmod_allocate_sparse(n, n, most, 0, 1, -1, CHOLMOD_PATTERN, common);
  if (!out) return NULL;
  int *start = out->p, *row = out->i, at = 0;
  for (int i = 0; i < g->n; i++) {
    if (number[i] < 0) continue;
    start[number[i]] = at;
    row[at++]        = number[i];
    for (int k = g->start[i]; k < g->start[i + 1]; k++)
      if (number[g->node[k]] > number[i]) row[at++] = number[g->node[k]];
  }
  start[kept] = at;
  return out;
}

/* Dissect the graph.
 *   set   out  [kept] of each node
 *   work  out  [kept]
 * Returns the number of sets, -1 on failure. */
static int dissect(cholmod_sparse *graph, cholmod_common *common, separators *tree, int *set,
                   int *work) {
  const struct cholmod_method_struct before = common->method[0];
  common->current                           = 0;
  common->method[0].nd_small                = SMALLEST;
  common->method[0].nd_camd                 = 0;
  const int sets = (int)cholmod_nested_dissection(graph, NULL, 0, work, tree->parent, set, common);
  common->method[0] = before;
  for (int i = 0; i < sets; i++) tree->first[i] = i;
  for (int i = 0; i < sets; i++) {
    const int up = tree->parent[i];
    if (up >= 0 && tree->first[i] < tree->first[up]) tree->first[up] = tree->first[i];
  }
  return sets;
}

/* ------------------------------------------------------------------ all nodes */

/* Is set a below set b, or the same? */
static bool is_below(const separators *t, int a, int b) {
  return t->first[b] <= a && a <= b;
}

/* The lowest set above both. */
static int meet(const separators *t, int a, int b) {
  while (t->parent[a] >= 0 && !is_below(t, b, a)) a = t->parent[a];
  return a;
}

/* Set of a dominated node: the lowest of its kept neighbours' if these lie above each other, else
 * the one in which they meet. */
static int set_between(const neighbours *g, const separators *t, const int *number, const int *set,
                       int i) {
  int  own    = -1;
  bool forked = false;
  for (int k = g->start[i]; k < g->start[i + 1]; k++) {
    const int near = number[g->node[k]];
    if (near < 0) continue;
    if (own < 0 || (is_below(t, set[near], own) && !forked))
      own = set[near];
    else if (!is_below(t, set[near], own) && !is_below(t, own, set[near])) {
      forked = true;
      own    = meet(t, own, set[near]);
    }
  }
  return own;
}

/* Move up dominated nodes that have a neighbour in another branch. Sets only rise, so this ends. */
static void part_branches(const neighbours *g, const separators *t, const int *number, int *set) {
  for (bool moved = true; moved;) {
    moved = false;
    for (int i = 0; i < g->n; i++)
      for (int k = g->start[i]; number[i] < 0 && k < g->start[i + 1]; k++) {
        const int other = set[g->node[k]];
        if (is_below(t, set[i], other) || is_below(t, other, set[i])) continue;
        const int up = meet(t, set[i], other);
        moved        = moved || up != set[i];
        set[i]       = up;
      }
  }
}

/* set  out  [n] of all nodes */
static void spread(const neighbours *g, const separators *t, const int *number, const int *kept_set,
                   int *set) {
  for (int i = 0; i < g->n; i++)
    set[i] = number[i] >= 0 ? kept_set[number[i]] : set_between(g, t, number, kept_set, i);
  part_branches(g, t, number, set);
}

/* As fem_coarse_order. number, set: room for [n]. */
static bool order_by(const neighbours *g, cholmod_sparse *graph, cholmod_common *common,
                     int *number, int *set, int *order) {
  const int kept = number_kept(g, number);
  if (kept == 0 || FEWER * (size_t)kept > (size_t)g->n) return false;
  const size_t    room     = (size_t)kept + 1;
  separators      tree     = {shb_alloc(room, sizeof(int)), shb_alloc(room, sizeof(int))};
  int            *kept_set = shb_alloc(room, sizeof(int));
  cholmod_sparse *few      = kept_graph(g, number, kept, common);
  const bool      good     = few && dissect(few, common, &tree, kept_set, order) > 0;
  if (good) spread(g, &tree, number, kept_set, set);
  cholmod_free_sparse(&few, common);
  free(tree.parent);
  free(tree.first);
  free(kept_set);
  return good && cholmod_camd(graph, NULL, 0, set, order, common);
}

bool fem_coarse_order(cholmod_sparse *graph, cholmod_common *common, int *order) {
  neighbours g      = {0};
  int       *number = shb_alloc(graph->ncol + 1, sizeof *number);
  int       *set    = shb_alloc(graph->ncol + 1, sizeof *set);
  list_neighbours(graph, &g);
  const bool good = order_by(&g, graph, common, number, set, order);
  free_neighbours(&g);
  free(number);
  free(set);
  return good;
}
