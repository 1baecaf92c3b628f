/* The least value along a line: smooth, with a kink, a jump, and where values are missing. */
#include "cases/study/line_minimum.h"

#include <math.h>

#include "tests/support/check.h"

typedef struct {
  double (*value)(double u);
  double (*slope)(double u); /* NULL: not known */
  int    n, most;            /* evaluations, and how many are allowed; 0: any number */
  double best, at;
} line;

static bool evaluate(void *context, double u, double *value, double *slope) {
  line *l = context;
  if (l->most > 0 && l->n == l->most) return false;
  l->n++;
  *value = l->value(u);
  *slope = l->slope ? l->slope(u) : NAN;
  if (*value < l->best) {
    l->best = *value;
    l->at   = u;
  }
  return true;
}

static line search(double (*value)(double), double (*slope)(double), double width, int most) {
  line l = {value, slope, 0, most, INFINITY, NAN};
  line_minimum(0, 1, width, evaluate, &l);
  return l;
}

static double bowl(double u) {
  return 1 + pow(u - 0.3, 2) * exp(u);
}
static double bowl_slope(double u) {
  return (u - 0.3) * (2 + u - 0.3) * exp(u);
}

/* Two curved sides that meet at KINK, 0.4 to the left or to the right of the minimum of either. */
static const double KINK = 0.41;

static double sides(double u) {
  double left  = 2 - 1.3 * (u - KINK) + 0.9 * pow(u - KINK, 2),
         right = 2 + 0.4 * (u - KINK) + 1.7 * pow(u - KINK, 3);
  return fmax(left, right);
}
static double sides_slope(double u) {
  return u < KINK ? -1.3 + 1.8 * (u - KINK) : 0.4 + 5.1 * pow(u - KINK, 2);
}

/* Hollows, so that both tangents lie above the function. */
static double hollow(double u) {
  double left  = 2 - 2 * (u - KINK) + 1.1 * pow(u - KINK, 3),
         right = 2 + 3 * (u - KINK) - 1.2 * pow(u - KINK, 3);
  return fmax(left, right);
}
static double hollow_slope(double u) {
  return u < KINK ? -2 + 3.3 * pow(u - KINK, 2) : 3 - 3.6 * pow(u - KINK, 2);
}

static double waves(double u) {
  return 2 + cos(4 * 3.141592653589793 * u) + 0.3 * u;
}
static double waves_slope(double u) {
  return -4 * 3.141592653589793 * sin(4 * 3.141592653589793 * u) + 0.3;
}

static double step(double u) {
  return u < 0.62 ? 2 - u : 3 + u;
}
static double step_slope(double u) {
  return u < 0.62 ? -1 : 1;
}

static double partly(double u) {
  return u > 0.9 ? INFINITY : bowl(u);
}

static double falling(double u) {
  return 1 - u;
}
static double falling_slope(double u) {
  (void)u;
  return -1;
}

static void a_smooth_minimum_is_exact(void **state) {
  (void)state;
  line l = search(bowl, bowl_slope, 1e-6, 0);
  print_message("smooth: %d evaluations, off by %.1e\n", l.n, fabs(l.at - 0.3));
  assert_below(fabs(l.at - 0.3), 1e-6);
  assert_true(l.n <= 11);
}

/* A bracket a hundred times narrower takes at most a few points more: superlinear. */
static void a_kink_is_closed_superlinearly(void **state) {
  (void)state;
  line wide = search(sides, sides_slope, 1e-6, 0), narrow = search(sides, sides_slope, 1e-8, 0),
       other = search(hollow, hollow_slope, 1e-8, 0);
  print_message("kink: %d evaluations to %.1e, %d to %.1e; concave %d to %.1e\n", wide.n,
                fabs(wide.at - KINK), narrow.n, fabs(narrow.at - KINK), other.n,
                fabs(other.at - KINK));
  assert_below(fabs(wide.at - KINK), 1e-6);
  assert_below(fabs(narrow.at - KINK), 1e-8);
  assert_below(fabs(other.at - KINK), 1e-8);
  assert_true(narrow.n <= wide.n + 5 && wide.n <= 15);
}

static void the_lower_of_two_minima_is_taken(void **state) {
  (void)state;
  line l = search(waves, waves_slope, 1e-6, 0);
  assert_below(fabs(waves_slope(l.at)), 1e-4);
  assert_below(l.at, 0.5);
}

static void a_jump_ends_the_search(void **state) {
  (void)state;
  line l = search(step, step_slope, 1e-6, 0);
  assert_below(fabs(l.at - 0.62), 2e-6);
  assert_true(l.n < 45);
}

static void a_bound_may_be_the_least(void **state) {
  (void)state;
  line l = search(falling, falling_slope, 1e-6, 0);
  assert_float_equal(l.at, 1, 0);
  assert_int_equal(l.n, 5);
}

static void slopes_and_values_may_be_missing(void **state) {
  (void)state;
  line none = search(bowl, NULL, 1e-6, 0), part = search(partly, bowl_slope, 1e-6, 0);
  assert_below(fabs(none.at - 0.3), 1e-4); /* differences over 1e-4 */
  assert_below(fabs(part.at - 0.3), 1e-6);
}

static void the_caller_ends_the_search(void **state) {
  (void)state;
  for (int most = 1; most < 12; most++)
    assert_true(search(sides, sides_slope, 1e-9, most).n <= most);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_smooth_minimum_is_exact),
                                     cmocka_unit_test(a_kink_is_closed_superlinearly),
                                     cmocka_unit_test(the_lower_of_two_minima_is_taken),
                                     cmocka_unit_test(a_jump_ends_the_search),
                                     cmocka_unit_test(a_bound_may_be_the_least),
                                     cmocka_unit_test(slopes_and_values_may_be_missing),
                                     cmocka_unit_test(the_caller_ends_the_search)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
