/* Solves with a Hermitian factor: phases, and residuals against the dense matrix. */
#include "fem/supernodal/supernodal_hermitian.h"

#include "tests/support/block_wave.h"
#include "tests/support/check.h"

static void phases_are_powers_of_the_turn(void **state) {
  (void)state;
  fem_hermitian_panels p;
  for (double theta = -3; theta < 3.2; theta += 0.7) {
    fem_hermitian_set_phase(cexp(I * theta), &p);
    for (int g = -2 * FEM_MOST_TURN; g <= 2 * FEM_MOST_TURN; g++)
      assert_small(cabs(fem_hermitian_phase(&p, g) - cexp(I * theta * g)),
                   1e-15 * 2 * FEM_MOST_TURN);
  }
}

/* Greatest |A x - b| of four random columns. */
static double residual(block_wave *w) {
  const size_t       n = (size_t)w->f.n, rows = (size_t)w->f.panels.most_rows;
  fem_complex_lanes *x     = aligned_alloc(64, (n + 1) * sizeof *x);
  fem_complex_lanes *b     = aligned_alloc(64, (n + 1) * sizeof *b);
  fem_complex_lanes *v     = aligned_alloc(64, (rows + 1) * sizeof *v);
  uint64_t           seed  = 3;
  double             worst = 0;
  double complex    *A     = block_factor_dense_complex(&w->f, (const double complex(*)[9])w->all);
  assert_true(x && b && v);
  for (size_t i = 0; i < n; i++)
    for (int c = 0; c < FEM_LANES; c++) {
      b[i].re[c] = block_random(&seed);
      b[i].im[c] = block_random(&seed);
    }
  memcpy(x, b, n * sizeof *x);
  fem_supernodal_solve_hermitian(&w->panels, x, v);
  for (size_t i = 0; i < n; i++)
    for (int c = 0; c < FEM_LANES; c++) {
      double complex sum = -CMPLX(b[i].re[c], b[i].im[c]);
      for (size_t j = 0; j < n; j++) sum += A[j * n + i] * CMPLX(x[j].re[c], x[j].im[c]);
      worst = fmax(worst, cabs(sum));
    }
  free(x);
  free(b);
  free(v);
  free(A);
  return worst;
}

static void check(block_grid grid, signed char *exponent, double diagonal) {
  block_wave w;
  int        real = 0;
  assert_true(block_wave_make(&grid, exponent, 1.1, diagonal, &w));
  assert_true(block_wave_factorise(&w));
  for (int k = 0; k < w.f.panels.n_panels; k++) real += w.turns.is_real[k];
  const double worst = residual(&w);
  print_message("%d rows, %d of %d panels real: %.1e\n", w.f.n, real, w.f.panels.n_panels, worst);
  assert_below(worst, 1e-13);
  block_wave_free(&w);
  block_grid_free(&grid);
}

static void real_panels(void **state) {
  (void)state;
  const block_grid grid = block_grid_make((const int[]){7, 3, 2}, 1, 1);
  check(grid, block_wave_exponents(&grid, NULL), 40);
}

static void real_panels_with_phases(void **state) {
  (void)state;
  const block_grid grid = block_grid_make((const int[]){7, 3, 2}, 1, 1);
  int             *h    = calloc((size_t)grid.blocks.n, sizeof *h);
  for (int i = 0; i < grid.blocks.n; i++) h[i] = i % 8 < 4;
  check(grid, block_wave_exponents(&grid, h), 40);
  free(h);
}

static signed char *any_blocks(const block_grid *grid, int each) {
  signed char *e = block_wave_exponents(grid, NULL);
  for (int k = 0; k < grid->start[grid->blocks.n]; k += each) e[k] = FEM_ANY_BLOCK;
  return e;
}

static void complex_panels(void **state) {
  (void)state;
  const block_grid all = block_grid_make((const int[]){7, 3, 2}, 1, 1);
  check(all, any_blocks(&all, 1), 60);
  const block_grid some = block_grid_make((const int[]){7, 3, 2}, 1, 1);
  check(some, any_blocks(&some, 251), 40);
}

static void odd_and_small_sizes(void **state) {
  (void)state;
  for (int n = 0; n <= 9; n++)
    for (int each = 1; each <= 3; each++) {
      const block_grid grid = block_grid_line(n, 2, false);
      check(grid, any_blocks(&grid, each), 15);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(phases_are_powers_of_the_turn), cmocka_unit_test(real_panels),
      cmocka_unit_test(real_panels_with_phases),       cmocka_unit_test(complex_panels),
      cmocka_unit_test(odd_and_small_sizes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
