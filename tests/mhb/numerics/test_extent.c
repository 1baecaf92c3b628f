/* Largest distance between two instants: against a scan, and its derivative. Values of single
 * formulas are in tests/postproc/analysis/test_outputs.c. */
#include "mhb/numerics/extent.h"

#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/random.h"
#include "tests/support/check.h"

enum { M = 5, AXES = 3, SIZE = AXES * (M + 1) };

static void random_motion(unsigned seed, double complex *a) {
  unsigned long long state = seed;
  for (int i = 0; i < SIZE; i++) {
    const int    k    = i % (M + 1);
    const double size = 1 / (1. + 2 * k * k);
    a[i]              = size * CMPLX(mhb_random(&state), mhb_random(&state));
  }
}

static void position(const double complex *a, double t, double x[AXES]) {
  for (int axis = 0; axis < AXES; axis++) {
    double complex sum = 0;
    for (int k = 0; k <= M; k++) sum += a[axis * (M + 1) + k] * cexp(I * k * t);
    x[axis] = creal(sum);
  }
}

static double scanned(const double complex *a) {
  enum { N = 1500 };
  static double x[N][AXES];
  double        most = 0;
  for (int i = 0; i < N; i++) position(a, SHB_TWO_PI * i / N, x[i]);
  for (int i = 0; i < N; i++)
    for (int j = 0; j < i; j++) {
      double square = 0;
      for (int axis = 0; axis < AXES; axis++) square += pow(x[i][axis] - x[j][axis], 2);
      most = fmax(most, square);
    }
  return sqrt(most);
}

static void it_is_the_largest_distance_of_a_scan(void **state) {
  (void)state;
  double complex a[SIZE];
  for (unsigned seed = 1; seed <= 30; seed++) {
    random_motion(seed, a);
    const mhb_extent e = mhb_extent_of(AXES, M, a);
    double           x[AXES], y[AXES], square = 0;
    position(a, e.t, x);
    position(a, e.s, y);
    for (int axis = 0; axis < AXES; axis++) square += pow(x[axis] - y[axis], 2);
    assert_near(sqrt(square), e.length, 1e-14 * e.length);
    assert_true(e.length >= scanned(a) * (1 - 1e-14));
    assert_near(scanned(a), e.length, 1e-4 * e.length);
  }
}

/* dD along da by the formula. */
static double slope_along(const mhb_extent *e, const double complex *da) {
  double complex w[AXES];
  double         sum = 0;
  for (int k = 0; k <= M; k++) {
    mhb_extent_weight(e, AXES, k, w);
    for (int axis = 0; axis < AXES; axis++) sum += creal(w[axis] * da[axis * (M + 1) + k]);
  }
  return sum;
}

static mhb_extent moved(const double complex *a, const double complex *da, double by) {
  double complex b[SIZE];
  for (int i = 0; i < SIZE; i++) b[i] = a[i] + by * da[i];
  return mhb_extent_of(AXES, M, b);
}

/* The instants move with the motion. The derivative at fixed instants is exact in spite of that.
 * Central differences of D come to it with their second order. */
static void its_derivative_is_that_at_fixed_instants(void **state) {
  (void)state;
  double complex a[SIZE], da[SIZE];
  for (unsigned seed = 1; seed <= 20; seed++) {
    double error[2];
    random_motion(seed, a);
    random_motion(seed + 100, da);
    const mhb_extent e = mhb_extent_of(AXES, M, a);
    for (int i = 0; i < 2; i++) {
      const double h = i ? 5e-4 : 1e-3;
      error[i]       = (moved(a, da, h).length - moved(a, da, -h).length) / (2 * h);
      error[i]       = fabs(error[i] - slope_along(&e, da));
    }
    assert_below(error[1], 2e-6);
    if (error[0] > 1e-9) assert_in_range(100 * error[0] / error[1], 370, 430);
  }
}

/* Derivatives of second order are differences of the first: the instants are known to rounding, so
 * a step of 1e-6 suffices. Known to the root of rounding only, the error would be 1e-2. */
static void the_instants_are_exact_enough_for_a_second_derivative(void **state) {
  (void)state;
  double complex a[SIZE], da[SIZE];
  double         worst = 0;
  for (unsigned seed = 1; seed <= 20; seed++) {
    random_motion(seed, a);
    random_motion(seed + 100, da);
    double bend[2];
    for (int i = 0; i < 2; i++) {
      const double     h  = i ? 1e-6 : 1e-3;
      const mhb_extent up = moved(a, da, h), down = moved(a, da, -h);
      bend[i] = (slope_along(&up, da) - slope_along(&down, da)) / (2 * h);
    }
    worst = fmax(worst, fabs(bend[1] - bend[0]) / (1 + fabs(bend[0])));
  }
  print_message("second derivative by steps 1e-6 and 1e-3: %.1e\n", worst);
  assert_below(worst, 2e-4);
}

static void at_rest_it_is_nothing(void **state) {
  (void)state;
  const double complex a[SIZE] = {3, 0};
  double complex       w[AXES];
  const mhb_extent     e = mhb_extent_of(AXES, M, a);
  assert_near(e.length, 0, 0);
  for (int k = 0; k <= M; k++) {
    mhb_extent_weight(&e, AXES, k, w);
    for (int axis = 0; axis < AXES; axis++) assert_near(cabs(w[axis]), 0, 0);
  }
  const mhb_extent alone = mhb_extent_of(1, 0, a); /* no harmonic at all */
  assert_near(alone.length, 0, 0);
}

/* Where two pairs of instants are equally far apart, D is the larger of two smooth functions: its
 * slope jumps upwards. A maximum is no such place. */
static void a_change_of_the_instants_is_a_kink_upwards(void **state) {
  (void)state;
  double complex a[SIZE] = {0}, da[SIZE] = {0};
  a[2]  = -1; /* -cos 2t has its minimum at 0 and at pi */
  da[1] = 1;  /* cos t lowers one of the two: D = 2 + |by| */
  for (int i = -3; i <= 3; i++) {
    const double     by = i * 1e-3;
    const mhb_extent e  = moved(a, da, by);
    assert_near(e.length, 2 + fabs(by), 2e-6); /* the maximum rises by by^2/8 */
    if (i) assert_near(slope_along(&e, da), i < 0 ? -1 : 1, 1e-3);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(it_is_the_largest_distance_of_a_scan),
      cmocka_unit_test(its_derivative_is_that_at_fixed_instants),
      cmocka_unit_test(the_instants_are_exact_enough_for_a_second_derivative),
      cmocka_unit_test(at_rest_it_is_nothing),
      cmocka_unit_test(a_change_of_the_instants_is_a_kink_upwards)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
