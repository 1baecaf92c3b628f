/* The order of the nodes from the corners of elements: it is one, and it fills little. */
#include "fem/supernodal/coarse_order.h"

#include "tests/support/block_grid.h"
#include "tests/support/check.h"

/* A graph, and CHOLMOD's copy. */
typedef struct {
  block_grid      grid;
  cholmod_sparse *graph;
  cholmod_common  common;
} pattern;

static pattern make_grid(const int cells[3], int step, int bodies) {
  pattern      p = {.grid = block_grid_make(cells, step, bodies)};
  const size_t n = (size_t)p.grid.blocks.n, count = (size_t)p.grid.start[n];
  fem_cholmod_start(&p.common);
  p.graph = cholmod_allocate_sparse(n, n, count, 1, 1, -1, CHOLMOD_PATTERN, &p.common);
  assert_non_null(p.graph);
  memcpy(p.graph->p, p.grid.start, (n + 1) * sizeof(int));
  memcpy(p.graph->i, p.grid.column, count * sizeof(int));
  return p;
}

static void free_pattern(pattern *p) {
  cholmod_free_sparse(&p->graph, &p->common);
  cholmod_finish(&p->common);
  block_grid_free(&p->grid);
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
  const int n     = p.grid.blocks.n;
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
  int      *order    = malloc((size_t)p.grid.blocks.n * sizeof *order);
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
