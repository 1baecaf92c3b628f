/* Random deviations of the blades of a ring. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "mhb/mistuning/deviations.h"
#include "tests/support/check.h"

enum { MANY = 20000 };

/* Moments of a normal distribution within four standard errors; odd numbers too. */
static void are_normal(void **state) {
  static double x[MANY + 1];
  double        mean = 0, square = 0, fourth = 0;
  (void)state;
  assert_ok(mhb_deviations_random(0.013, 7, 2, MANY + 1, x));
  for (int i = 0; i <= MANY; i++) {
    const double z = x[i] / 0.013;
    mean += z / (MANY + 1);
    square += z * z / (MANY + 1);
    fourth += z * z * z * z / (MANY + 1);
  }
  assert_small(mean, 4 / sqrt(MANY));
  assert_near(square, 1, 4 * sqrt(2. / MANY));
  assert_near(fourth, 3, 4 * sqrt(96. / MANY));
}

static void are_reproducible(void **state) {
  double a[7], b[7], c[7];
  (void)state;
  assert_ok(mhb_deviations_random(0.01, 7, 3, 7, a));
  assert_ok(mhb_deviations_random(0.01, 7, 4, 7, c));
  assert_ok(mhb_deviations_random(0.01, 7, 3, 7, b));
  assert_memory_equal(a, b, sizeof a);
  assert_true(fabs(a[0] - c[0]) > 1e-6 && fabs(a[6] - c[6]) > 1e-6);
  assert_ok(mhb_deviations_random(0.01, 8, 3, 7, c));
  assert_true(fabs(a[0] - c[0]) > 1e-6);
}

static void must_be_above_half(void **state) {
  static double x[MANY];
  (void)state;
  assert_refused(mhb_deviations_random(0.2, 1, 0, MANY, x), SHB_ERR_INPUT, "must be above -50 %");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(are_normal),
                                     cmocka_unit_test(are_reproducible),
                                     cmocka_unit_test(must_be_above_half)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
