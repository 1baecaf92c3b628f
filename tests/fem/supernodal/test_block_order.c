/* The order of the nodes, and the pattern of the factor: against elimination of the dense graph. */
#include "fem/supernodal/block_order.h"

#include "tests/support/block_grid.h"
#include "tests/support/check.h"

static const int cells[3] = {11, 3, 2};

static int entries(const bool *fill, int n) {
  int count = 0;
  for (int i = 0; i < n * n; i++) count += fill[i];
  return count;
}

static void the_order_is_a_permutation_with_less_fill(void **state) {
  (void)state;
  for (int step = 1; step <= 2; step++) {
    block_grid   grid = block_grid_make((const int[]){11 / step, 4 / step, 4 / step}, step, 1);
    const int    n    = grid.blocks.n;
    block_factor f;
    block_factor_make(&grid, &f);
    bool *met = calloc((size_t)n, sizeof *met);
    for (int i = 0; i < n; i++) {
      assert_in_range(f.place[i], 0, n - 1);
      assert_false(met[f.place[i]]);
      met[f.place[i]] = true;
    }
    bool     *ours = block_grid_fill(&grid, f.place), *natural = block_grid_fill(&grid, NULL);
    const int few = entries(ours, n), many = entries(natural, n);
    print_message("%d nodes: %d entries, %d in natural order\n", n, few, many);
    assert_true(few < many);
    free(met);
    free(ours);
    free(natural);
    block_factor_free(&f);

    block_grid_free(&grid);
  }
}

/* CHOLMOD's supernodes hold every entry of L, and few zeros. */
static void the_pattern_holds_every_entry(void **state) {
  (void)state;
  block_grid     grid  = block_grid_make(cells, 1, 2);
  const int      n     = grid.blocks.n;
  int           *place = malloc((size_t)n * sizeof *place), held = 0, stored = 0;
  cholmod_common common;
  fem_cholmod_start(&common);
  cholmod_factor *L = fem_block_analyse(&grid.blocks, &common, place);
  assert_non_null(L);
  assert_int_equal(L->n, n);
  bool      *fill  = block_grid_fill(&grid, place);
  const int *super = L->super, *pi = L->pi, *row = L->s;
  for (size_t s = 0; s < L->nsuper; s++)
    for (int c = super[s]; c < super[s + 1]; c++)
      for (int i = pi[s]; i < pi[s + 1]; i++) {
        stored += row[i] >= c;
        held += row[i] >= c && fill[(size_t)c * (size_t)n + (size_t)row[i]];
      }
  print_message("%d entries of L among %d\n", entries(fill, n), stored);
  assert_int_equal(held, entries(fill, n));
  assert_true(stored < 2 * held);
  free(fill);
  free(place);
  cholmod_free_factor(&L, &common);
  cholmod_finish(&common);
  block_grid_free(&grid);
}

/* Block q is that of row r and column c before the permutation; ~q is its transpose. */
static void the_lower_pattern_has_every_block_once(void **state) {
  (void)state;
  block_grid   grid = block_grid_make(cells, 1, 1);
  const int    n = grid.blocks.n, count = grid.start[n];
  block_factor f;
  block_factor_make(&grid, &f);
  int *row_of = malloc((size_t)count * sizeof *row_of), *met = calloc((size_t)count, sizeof *met);
  for (int r = 0; r < n; r++)
    for (int k = grid.start[r]; k < grid.start[r + 1]; k++) row_of[k] = r;
  assert_int_equal(f.lower.n, n);
  assert_int_equal(f.lower.start[0], 0);
  assert_int_equal(f.lower.start[n], count);
  for (int c = 0; c < n; c++)
    for (int k = f.lower.start[c]; k < f.lower.start[c + 1]; k++) {
      const int q = f.lower.block[k], at = q < 0 ? ~q : q, r = f.lower.row[k];
      const int upper = f.place[row_of[at]], right = f.place[grid.column[at]];
      assert_true(r >= c);
      assert_int_equal(r, q < 0 ? right : upper);
      assert_int_equal(c, q < 0 ? upper : right);
      met[at]++;
    }
  for (int k = 0; k < count; k++) assert_int_equal(met[k], 1);
  free(row_of);
  free(met);
  block_factor_free(&f);
  block_grid_free(&grid);
}

static void no_node_and_one_node(void **state) {
  (void)state;
  for (int n = 0; n <= 1; n++) {
    block_grid   grid = block_grid_line(n, 1, false);
    block_factor f;
    block_factor_make(&grid, &f);
    assert_int_equal(f.lower.start[n], n);
    if (n == 1) assert_int_equal(f.place[0], 0);
    block_factor_free(&f);
    block_grid_free(&grid);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_order_is_a_permutation_with_less_fill),
      cmocka_unit_test(the_pattern_holds_every_entry),
      cmocka_unit_test(the_lower_pattern_has_every_block_once),
      cmocka_unit_test(no_node_and_one_node),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
