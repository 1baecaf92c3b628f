/* The complex panels of a Hermitian factor: against LAPACK's dense one. */
#include "fem/supernodal/hermitian_factor.h"

#include <lapacke.h>

#include "tests/support/block_wave.h"
#include "tests/support/check.h"

static const double theta = 1.1;

/* Entry of L in a panel: its own numbers, or real ones with the phases of its rows. */
static double complex entry(const block_wave *w, int k, int i, int c) {
  const fem_panel   *p  = &w->f.panels.panel[k];
  const signed char *g  = w->turns.g + p->row / 3;
  const size_t       at = p->value + (size_t)c * (size_t)p->rows + (size_t)i;
  if (w->turns.is_real[k]) return w->real_value[at] * cexp(I * theta * (g[i / 3] - g[c / 3]));
  return CMPLX(w->panels.other[at], w->panels.other[at + (size_t)p->columns * (size_t)p->rows]);
}

/* All panels against the dense factor. Returns the number of real ones. */
static int check(block_grid grid, signed char *exponent, double diagonal) {
  block_wave w;
  double     worst = 0;
  int        real  = 0;
  assert_true(block_wave_make(&grid, exponent, theta, diagonal, &w));
  assert_true(block_wave_factorise(&w));
  double complex *L = block_factor_dense_complex(&w.f, (const double complex(*)[9])w.all);
  assert_int_equal(LAPACKE_zpotrf(LAPACK_COL_MAJOR, 'L', w.f.n, L, w.f.n), 0);
  for (int k = 0; k < w.f.panels.n_panels; k++) {
    const fem_panel *p = &w.f.panels.panel[k];
    real += w.turns.is_real[k];
    for (int c = 0; c < p->columns; c++)
      for (int i = c; i < p->rows; i++) {
        const size_t at =
            (size_t)(p->first + c) * (size_t)w.f.n + (size_t)block_factor_row(&w.f, k, i);
        worst = fmax(worst, cabs(entry(&w, k, i, c) - L[at]));
      }
  }
  print_message("%d rows, %d of %d panels real: %.1e\n", w.f.n, real, w.f.panels.n_panels, worst);
  assert_below(worst, 1e-13);
  free(L);
  block_wave_free(&w);
  block_grid_free(&grid);
  return real;
}

static signed char *any_blocks(const block_grid *grid) {
  signed char *e = block_wave_exponents(grid, NULL);
  memset(e, FEM_ANY_BLOCK, (size_t)grid->start[grid->blocks.n]);
  return e;
}

static void blocks_of_any_numbers(void **state) {
  (void)state;
  const block_grid body = block_grid_make((const int[]){9, 3, 2}, 1, 1);
  assert_int_equal(check(body, any_blocks(&body), 60), 0);
  const block_grid full = block_grid_line(70, 70, false); /* two panels of one supernode */
  assert_int_equal(check(full, any_blocks(&full), 60), 0);
}

static void odd_and_small_sizes(void **state) {
  (void)state;
  for (int n = 1; n <= 9; n++) {
    const block_grid grid = block_grid_line(n, 2, false);
    check(grid, any_blocks(&grid), 15);
  }
}

/* Blocks from one half of a ring to the other carry a phase: some panels are real with phases,
 * and complex ones collect their updates. */
static void real_panels_below_complex_ones(void **state) {
  (void)state;
  const block_grid grid = block_grid_line(80, 3, true);
  signed char     *e    = block_wave_exponents(&grid, NULL);
  for (int r = 0; r < 80; r++)
    for (int k = grid.start[r]; k < grid.start[r + 1]; k++)
      e[k] = (signed char)(grid.column[k] - r > 40 ? 1 : r < 23 && grid.column[k] >= 23 ? -1 : 0);
  assert_true(check(grid, e, 40) > 2);
}

static void a_mixture_of_all_kinds(void **state) {
  (void)state;
  const block_grid grid = block_grid_make((const int[]){11, 3, 2}, 1, 1);
  signed char     *e    = block_wave_exponents(&grid, NULL);
  for (int k = 1; k < grid.start[grid.blocks.n]; k += 391) e[k] = FEM_ANY_BLOCK;
  for (int r = 0; r < grid.blocks.n; r++)
    for (int k = grid.start[r]; k < grid.start[r + 1]; k++)
      if (e[k] == 0) e[k] = (signed char)((r % 12 < 5) - (grid.column[k] % 12 < 5));
  assert_true(check(grid, e, 40) > 2);
}

static void a_matrix_that_is_not_definite_is_told(void **state) {
  (void)state;
  block_grid grid = block_grid_make((const int[]){5, 3, 2}, 1, 1);
  block_wave w;
  assert_true(block_wave_make(&grid, any_blocks(&grid), theta, 40, &w));
  w.coupled[w.coupled_at[grid.start[31]]][4] = -0.01; /* a number on the diagonal */
  assert_false(block_wave_factorise(&w));
  block_wave_free(&w);
  block_grid_free(&grid);
}

static void the_workspace_is_that_of_two_updates(void **state) {
  (void)state;
  const fem_supernodes s = {.n = 1000, .most_rows = 300};
  assert_near(fem_hermitian_workspace(&s), 4 * 1000 + 300 * (2 * 8 * 120 + 4), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(blocks_of_any_numbers),
      cmocka_unit_test(odd_and_small_sizes),
      cmocka_unit_test(real_panels_below_complex_ones),
      cmocka_unit_test(a_mixture_of_all_kinds),
      cmocka_unit_test(a_matrix_that_is_not_definite_is_told),
      cmocka_unit_test(the_workspace_is_that_of_two_updates),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
