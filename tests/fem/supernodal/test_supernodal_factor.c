/* The factor by panels: against LAPACK's dense one. */
#include "fem/supernodal/supernodal_factor.h"

#include <lapacke.h>
#include <omp.h>

#include "tests/support/block_grid.h"
#include "tests/support/check.h"

static const uint64_t seed = 2385;

static bool factorise(const block_factor *f, const double *block, const bool *only, double *value) {
  return fem_supernodal_factorise(&f->panels, &f->lower, block, only, value);
}

/* The dense factor: lower triangle by columns. */
static double *dense_factor(const block_factor *f, const double *block) {
  double *L = block_factor_dense(f, block);
  assert_int_equal(LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', f->n, L, f->n > 0 ? f->n : 1), 0);
  return L;
}

/* Greatest difference of the panels' numbers from the dense factor, relative to its greatest. */
static double difference(const block_factor *f, const double *value, const double *L,
                         const bool *only) {
  double worst = 0, most = 0;
  for (int k = 0; k < f->panels.n_panels; k++) {
    const fem_panel *p = &f->panels.panel[k];
    for (int c = 0; (!only || only[k]) && c < p->columns; c++)
      for (int i = c; i < p->rows; i++) {
        const size_t row = (size_t)block_factor_row(f, k, i), column = (size_t)(p->first + c);
        const double wanted = L[column * (size_t)f->n + row];
        const double given  = value[p->value + (size_t)c * (size_t)p->rows + (size_t)i];
        worst               = fmax(worst, fabs(given - wanted));
        most                = fmax(most, fabs(wanted));
      }
  }
  return most > 0 ? worst / most : worst;
}

static void check(block_grid grid, double diagonal) {
  block_factor f;
  block_factor_make(&grid, &f);
  double *block = block_grid_values(&grid, diagonal, seed), *L = dense_factor(&f, block);
  assert_true(factorise(&f, block, NULL, f.value));
  const double off = difference(&f, f.value, L, NULL);
  print_message("%d rows in %d panels: %.1e\n", f.n, f.panels.n_panels, off);
  assert_below(off, 1e-14);
  free(block);
  free(L);
  block_factor_free(&f);
  block_grid_free(&grid);
}

static void the_factor_is_the_dense_one(void **state) {
  (void)state;
  check(block_grid_make((const int[]){12, 4, 2}, 1, 1), 40);
  check(block_grid_make((const int[]){5, 2, 1}, 2, 2), 40);
  check(block_grid_line(71, 4, true), 40);
}

/* 300 columns in one supernode are three panels. */
static void a_full_matrix(void **state) {
  (void)state;
  check(block_grid_line(100, 100, false), 60);
}

static void odd_and_small_sizes(void **state) {
  (void)state;
  for (int n = 0; n <= 9; n++) check(block_grid_line(n, 2, false), 9);
}

/* Left-looking in a fixed order: threads do not change a bit. */
static void threads_do_not_change_the_numbers(void **state) {
  (void)state;
  block_grid   grid = block_grid_make((const int[]){12, 4, 2}, 1, 1);
  block_factor f;
  const int    most = omp_get_max_threads();
  block_factor_make(&grid, &f);
  double *block = block_grid_values(&grid, 40, seed);
  double *one   = malloc(f.panels.n_values * sizeof *one);
  omp_set_num_threads(1);
  assert_true(factorise(&f, block, NULL, one));
  omp_set_num_threads(3);
  assert_true(factorise(&f, block, NULL, f.value));
  omp_set_num_threads(most);
  for (int k = 0; k < f.panels.n_panels; k++) {
    const fem_panel *p = &f.panels.panel[k];
    for (int c = 0; c < p->columns; c++) {
      const size_t at = p->value + (size_t)c * (size_t)(p->rows + 1);
      assert_memory_equal(one + at, f.value + at, (size_t)(p->rows - c) * sizeof *one);
    }
  }
  free(one);
  free(block);
  block_factor_free(&f);
  block_grid_free(&grid);
}

/* Some panels with all below them: these are filled, the others are left alone. */
static void only_the_wanted_panels_are_filled(void **state) {
  (void)state;
  block_grid   grid = block_grid_make((const int[]){12, 4, 2}, 1, 1);
  block_factor f;
  block_factor_make(&grid, &f);
  const fem_supernodes *s     = &f.panels;
  double               *block = block_grid_values(&grid, 40, seed), *L = dense_factor(&f, block);
  bool                 *only    = calloc((size_t)s->n_panels, sizeof *only);
  int                   skipped = 0;
  for (int k = 0; k < s->n_panels; k++) only[k] = k % 5 != 2;
  for (int k = 0; k < s->n_panels; k++) { /* a panel above one that is left out is left out */
    const fem_panel *p = &s->panel[k];
    if (!only[k] && p->rows > p->columns)
      only[f.owner[block_factor_row(&f, k, p->columns)]] = false;
    skipped += !only[k];
  }
  for (size_t i = 0; i < s->n_values; i++) f.value[i] = -7;
  assert_true(factorise(&f, block, only, f.value));
  print_message("%d of %d panels left out\n", skipped, s->n_panels);
  assert_true(skipped > 0 && skipped < s->n_panels);
  assert_below(difference(&f, f.value, L, only), 1e-14);
  for (int k = 0; k < s->n_panels; k++)
    for (int i = 0; !only[k] && i < s->panel[k].rows * s->panel[k].columns; i++)
      assert_true(f.value[s->panel[k].value + (size_t)i] == -7);
  free(only);
  free(block);
  free(L);
  block_factor_free(&f);
  block_grid_free(&grid);
}

/* One negative pivot, anywhere, is told. */
static void a_matrix_that_is_not_definite_is_told(void **state) {
  (void)state;
  block_grid   grid = block_grid_make((const int[]){7, 3, 2}, 1, 1);
  block_factor f;
  block_factor_make(&grid, &f);
  for (int node = 0; node < grid.blocks.n; node += 19) {
    double *block = block_grid_values(&grid, 40, seed);
    assert_int_equal(grid.column[grid.start[node]], node);
    block[9 * (size_t)grid.start[node] + 4] = -0.01;
    assert_false(factorise(&f, block, NULL, f.value));
    free(block);
  }
  block_factor_free(&f);
  block_grid_free(&grid);
}

static void each_thread_has_its_workspace(void **state) {
  (void)state;
  const fem_supernodes s = {.n = 1000, .most_rows = 300};
  assert_near(fem_supernodal_workspace(&s, 1), 4 * 1000 + 300 * (8 * 120 + 4), 0);
  assert_near(fem_supernodal_workspace(&s, 5), 5 * fem_supernodal_workspace(&s, 1), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_factor_is_the_dense_one),
      cmocka_unit_test(a_full_matrix),
      cmocka_unit_test(odd_and_small_sizes),
      cmocka_unit_test(threads_do_not_change_the_numbers),
      cmocka_unit_test(only_the_wanted_panels_are_filled),
      cmocka_unit_test(a_matrix_that_is_not_definite_is_told),
      cmocka_unit_test(each_thread_has_its_workspace),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
