/* The bracketing root finder: smooth, flat, kinked and jumping functions, and points that fail. */
#include "mesh/base/root.h"
#include "tests/support/check.h"

enum { SMOOTH, FLAT, KINK, JUMP, STEEP, TINY, N_FUNCTIONS };

static const double ROOT = .3183;

static double value(int function, double x) {
  double d = x - ROOT;
  switch (function) {
    case SMOOTH:
      return exp(d) - 1;
    case FLAT:
      return pow(d, 9);
    case KINK:
      return d < 0 ? d : sqrt(d);
    case JUMP:
      return d < 0 ? -1 : 1e6;
    case STEEP:
      return tanh(1e4 * d);
    default:
      return 1e-300 * d;
  }
}

/* How many steps; the bracket holds the root. */
static int solve(int function, double a, double b, double tolerance, shb_root *r) {
  int n = 0;
  assert_true(shb_root_start(r, a, value(function, a), b, value(function, b), tolerance));
  for (; !shb_root_done(r); n++) {
    double x = shb_root_next(r);
    assert_true(x > r->x[0] && x < r->x[1]);
    shb_root_found(r, x, value(function, x));
    assert_true(r->x[0] <= ROOT && ROOT <= r->x[1]);
  }
  assert_true(r->x[1] - r->x[0] <= tolerance);
  return n;
}

/* At most one step more than bisection, and one for rounding, from either end. */
static void no_worse_than_bisection(void **state) {
  (void)state;
  const double tolerance[] = {1e-3, 1e-9, 1e-13};
  for (int f = 0; f < N_FUNCTIONS; f++)
    for (int t = 0; t < 3; t++)
      for (int turned = 0; turned < 2; turned++) {
        shb_root r;
        int      n = solve(f, turned ? 1.7 : -.9, turned ? -.9 : 1.7, tolerance[t], &r);
        assert_true(n <= (int)ceil(log2(2.6 / tolerance[t])) + 2);
      }
}

/* A simple root: the number of right digits grows faster than linearly. */
static void smooth_is_fast(void **state) {
  (void)state;
  shb_root r;
  int      n = solve(SMOOTH, -.9, 1.7, 1e-13, &r);
  printf("steps to 1e-13: %d (bisection 45)\n", n);
  assert_true(n <= 12);
  assert_near(r.x[0], ROOT, 1e-13);
}

static void rounding_ends_it(void **state) {
  (void)state;
  shb_root r;
  assert_true(shb_root_start(&r, 1, -1, 2, 1, 0));
  for (int n = 0; !shb_root_done(&r); n++) {
    double x = shb_root_next(&r);
    assert_true(n < 60);
    shb_root_found(&r, x, x - sqrt(2) > 0 ? 1 : -1);
  }
  assert_near(r.x[0], sqrt(2), 1e-15);
}

static void zeros_are_roots(void **state) {
  (void)state;
  shb_root r;
  assert_true(shb_root_start(&r, 3, 0, 5, 7, 1e-9));
  assert_true(shb_root_done(&r) && r.x[0] == 3 && r.x[1] == 3);
  assert_true(shb_root_start(&r, 3, -1, 5, 1, 1e-9));
  shb_root_found(&r, 4.25, 0);
  assert_true(shb_root_done(&r) && r.x[0] == 4.25 && r.x[1] == 4.25);
}

static void one_sign_is_no_bracket(void **state) {
  (void)state;
  shb_root r;
  assert_false(shb_root_start(&r, 0, 1, 1, 2, 1e-9));
  assert_false(shb_root_start(&r, 0, -1, 1, -2, 1e-9));
  assert_false(shb_root_start(&r, 0, NAN, 1, 2, 1e-9));
}

/* An infinite value cannot be interpolated: the bracket is halved. */
static void infinite_values_are_bisected(void **state) {
  (void)state;
  shb_root r;
  assert_true(shb_root_start(&r, 0, -INFINITY, 1, 2, 1e-9));
  assert_near(shb_root_next(&r), .5, 0);
}

/* Near the root the function fails: the bracket shrinks to that zone and still holds the root. */
static void failures_are_passed_by(void **state) {
  (void)state;
  shb_root r;
  int      n_values = 0, left = 1;
  assert_true(shb_root_start(&r, 0, value(SMOOTH, 0), 1, value(SMOOTH, 1), 1e-9));
  while (!shb_root_done(&r) && left) {
    double x = shb_root_next(&r);
    if (fabs(x - ROOT) < .01) {
      left = shb_root_failed(&r);
    } else {
      shb_root_found(&r, x, value(SMOOTH, x));
      n_values++;
    }
  }
  assert_true(!left && n_values > 2);
  assert_true(r.x[0] < ROOT && ROOT < r.x[1] && r.x[1] - r.x[0] < .05);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(no_worse_than_bisection),
      cmocka_unit_test(smooth_is_fast),
      cmocka_unit_test(rounding_ends_it),
      cmocka_unit_test(zeros_are_roots),
      cmocka_unit_test(one_sign_is_no_bracket),
      cmocka_unit_test(failures_are_passed_by),
      cmocka_unit_test(infinite_values_are_bisected),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
