/* The order of the nodes from the corners of elements: it is one, and it fills little. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "fem/supernodal/block_order.h"
#include "fem/supernodal/coarse_order.h"

/* Upper triangle of a graph, and CHOLMOD's copy. */
typedef struct {
  fem_blocks      blocks;
  int            *start, *column;
  cholmod_sparse *graph;
  cholmod_common  common;
} pattern;

/* Nodes i, j of a grid with cells of step^3: is there a cell with both? */
static bool share_cell(int i, int j, int step) {
  const int low = i < j ? i : j, high = i < j ? j : i;
  return high <= low / step * step + step;
}

/* One body, or two that do not touch, of cells[0] x cells[1] x cells[2] cells. A cell has
 * (step + 1)^3 nodes: 27-node hexahedra for step 2, eight-node ones for step 1. */
static pattern make_grid(const int cells[3], int step, int bodies) {
  const int nx = step * cells[0] + 1, ny = step * cells[1] + 1, nz = step * cells[2] + 1;
  const int each = nx * ny * nz, n = bodies * each, most = 125 * n;
  pattern   p;
  p.start  = malloc(((size_t)n + 1) * sizeof(int));
  p.column = malloc((size_t)most * sizeof(int));
  int at   = 0;
  for (int r = 0; r < n; r++) {
    const int x = r % nx, y = r / nx % ny, z = r % each / (nx * ny), base = r / each * each;
    p.start[r] = at;
    for (int w = z; w < nz && w <= z + step; w++)
      for (int v = y - step < 0 ? 0 : y - step; v < ny && v <= y + step; v++)
        for (int u = x - step < 0 ? 0 : x - step; u < nx && u <= x + step; u++) {
          const int c = base + (w * ny + v) * nx + u;
          if (c >= r && share_cell(x, u, step) && share_cell(y, v, step) && share_cell(z, w, step))
            p.column[at++] = c;
        }
  }
  p.start[n] = at;
  p.blocks   = (fem_blocks){n, p.start, p.column};
  fem_cholmod_start(&p.common);
  p.graph = cholmod_allocate_sparse((size_t)n, (size_t)n, (size_t)at, 1, 1, -1, CHOLMOD_PATTERN,
                                    &p.common);
  for (int r = 0; r <= n; r++) ((int *)p.graph->p)[r] = p.start[r];
  for (int k = 0; k < at; k++) ((int *)p.graph->i)[k] = p.column[k];
  return p;
}

static void free_pattern(pattern *p) {
  cholmod_free_sparse(&p->graph, &p->common);
  cholmod_finish(&p->common);
  free(p->start);
  free(p->column);
}

static void check_permutation(const int *order, int n) {
  bool *met = calloc((size_t)n, sizeof *met);
  for (int i = 0; i < n; i++) {
    assert_in_range(order[i], 0, n - 1);
    assert_false(met[order[i]]);
    met[order[i]] = true;
  }
  free(met);
}

/* Operations of the factor of the nodes; order NULL: CHOLMOD's own nested dissection. */
static double operations(pattern *p, int *order) {
  p->common.method[0].ordering = order ? CHOLMOD_GIVEN : CHOLMOD_NESDIS;
  p->common.method[0].nd_small = 200;
  p->common.method[0].nd_camd  = 1;
  cholmod_factor *L            = cholmod_analyze_p(p->graph, order, NULL, 0, &p->common);
  assert_non_null(L);
  cholmod_free_factor(&L, &p->common);
  return p->common.fl;
}

static void check_fill(const int cells[3], int bodies, double most) {
  pattern   p     = make_grid(cells, 2, bodies);
  const int n     = p.blocks.n;
  int      *order = malloc((size_t)n * sizeof *order);
  assert_true(fem_coarse_order(p.graph, &p.common, order));
  check_permutation(order, n);
  const double coarse = operations(&p, order), fine = operations(&p, NULL);
  print_message("%d nodes: %.3g operations, %.3g by dissection of all\n", n, coarse, fine);
  assert_true(coarse < most * fine);
  free(order);
  free_pattern(&p);
}

static void fills_as_little(void **state) {
  (void)state;
  check_fill((const int[]){25, 6, 3}, 1, 1.1);
  check_fill((const int[]){11, 9, 8}, 1, 1.1);
  check_fill((const int[]){40, 2, 2}, 1, 1.1);
}

static void two_bodies(void **state) {
  (void)state;
  check_fill((const int[]){9, 5, 3}, 2, 1.1);
}

static void small_ones(void **state) {
  (void)state;
  const int cells[3] = {1, 1, 1};
  pattern   p        = make_grid(cells, 2, 1);
  int       order[27];
  assert_true(fem_coarse_order(p.graph, &p.common, order));
  check_permutation(order, 27);
  free_pattern(&p);
}

/* In a linear mesh only the nodes at the border are dominated. */
static void needs_corners(void **state) {
  (void)state;
  const int cells[3] = {12, 9, 7};
  pattern   p        = make_grid(cells, 1, 1);
  int      *order    = malloc((size_t)p.blocks.n * sizeof *order);
  assert_false(fem_coarse_order(p.graph, &p.common, order));
  free(order);
  free_pattern(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fills_as_little),
      cmocka_unit_test(two_bodies),
      cmocka_unit_test(small_ones),
      cmocka_unit_test(needs_corners),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
