/* The folded band of a ring against the dense elimination. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "mhb/numerics/lu.h"
#include "mhb/variation/variational.h"

static double noise(unsigned *seed) {
  *seed = *seed * 1664525u + 1013904223u;
  return *seed / 4294967296. - .5;
}

/* Rings of 1 to 12 blades with 1 and 2 pairs. */
static void bands_give_the_ring(void **state) {
  (void)state;
  unsigned seed = 3;
  for (int blades = 1; blades <= 12; blades++)
    for (int block = 3; block <= 6; block += 3) {
      int           n          = blades * block, near[3], pivot[72];
      double        A[72 * 72] = {0}, x[72], most = 0;
      mhb_columns   y[72], folded[72];
      mhb_ring_band band;
      mhb_ring_band_create(blades, block, &band);
      mhb_ring_band_clear(&band);
      for (int row = 0; row < n; row++) {
        int meets = mhb_ring_band_neighbours(&band, row / block, near);
        for (int k = 0; k < meets * block; k++) {
          int column          = near[k / block] * block + k % block;
          A[row * n + column] = *mhb_ring_band_at(&band, row, column) = noise(&seed);
        }
        x[row] = noise(&seed);
        for (int l = 0; l < MHB_COLUMNS; l++) y[row][l] = (l + 1) * x[row];
      }
      assert_true(mhb_factor_real(n, A, pivot));
      mhb_solve_real(n, A, pivot, x);
      assert_true(mhb_ring_band_factor(&band));
      mhb_ring_band_solve(&band, y, folded);
      double size = 0;
      for (int row = 0; row < n; row++) {
        size = fmax(size, fabs(x[row]));
        for (int l = 0; l < MHB_COLUMNS; l++) most = fmax(most, fabs(y[row][l] / (l + 1) - x[row]));
      }
      assert_true(most < 1e-9 * size);
      mhb_ring_band_destroy(&band);
    }
}

static void singular_ones_are_refused(void **state) {
  (void)state;
  mhb_ring_band band;
  mhb_ring_band_create(7, 3, &band);
  mhb_ring_band_clear(&band);
  assert_false(mhb_ring_band_factor(&band));
  mhb_ring_band_destroy(&band);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(bands_give_the_ring),
                                     cmocka_unit_test(singular_ones_are_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
