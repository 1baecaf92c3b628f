/* Order and sums of tails of known spectra. */
#include "mhb/numerics/tail.h"

#include <math.h>

#include "tests/support/check.h"

enum { LAST = 2000000 };

/* power[top + 1] of |u_k| = k^-p for odd k, or for all; the exact sums above in rms, sum. */
static void spectrum(double p, int step, int top, double *power, double *rms, double *sum) {
  *rms = *sum = 0;
  for (int k = 0; k <= top; k++) power[k] = 0;
  for (int k = 1; k < LAST; k += step) {
    const double size = pow(k, -p);
    if (k <= top) power[k] = size * size;
    if (k > top) *rms += size * size;
    if (k > top) *sum += size;
  }
  *rms = sqrt(*rms);
}

/* From 16 harmonics on. */
static void the_order_of_a_power_is_seen(void **state) {
  (void)state;
  for (int step = 1; step <= 2; step++)
    for (int top = 16; top <= 128; top *= 2)
      for (double p = 2; p <= 4; p++) {
        double power[129], rms, sum;
        spectrum(p, step, top, power, &rms, &sum);
        const mhb_tail tail = mhb_tail_of(top, power, 0);
        assert_true(fabs(tail.order - p) < 1.5 * p / top);
        assert_true(fabs(tail.rms / rms - 1) < 0.2);
        assert_true(fabs(tail.sum / sum - 1) < 0.2);
        assert_true(mhb_tail_of(top, power, 0.5).sum > tail.sum);
      }
}

static void a_smooth_motion_has_hardly_a_tail(void **state) {
  (void)state;
  double power[33];
  for (int k = 0; k <= 32; k++) power[k] = pow(4, -k);
  const mhb_tail tail = mhb_tail_of(32, power, 0.75);
  assert_true(tail.order > 8);
  assert_true(tail.sum < 2e-2 * pow(2, -17));
}

static void too_few_harmonics_say_nothing(void **state) {
  (void)state;
  const double power[33] = {0, 1, 0.1};
  assert_true(isinf(mhb_tail_of(7, power, 0).order) && mhb_tail_of(7, power, 0).rms == 0);
  assert_true(isinf(mhb_tail_of(32, power, 0).order) && mhb_tail_of(32, power, 0).sum == 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_order_of_a_power_is_seen),
                                     cmocka_unit_test(a_smooth_motion_has_hardly_a_tail),
                                     cmocka_unit_test(too_few_harmonics_say_nothing)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
