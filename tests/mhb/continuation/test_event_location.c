/* Location of the sign change of a test function on a step: accuracy, cost, jumps and kinks. */
#include "mhb/continuation/event_location.h"

#include "mhb/continuation/corrector.h"
#include "tests/support/check.h"
#include "tests/support/scalar_curve.h"

/* g = (value - at)(1 + bend (value - at)), or a jump there. Counts its calls. */
typedef struct {
  double at, bend;
  bool   jumps;
  int    n;
} crossing;

static double crossing_test(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  crossing *c    = context;
  double    away = point->value - c->at;
  (void)curve;
  c->n++;
  if (c->jumps) return away > 0 ? 3 : -1;
  return away * (1 + c->bend * away);
}

static double fold_test(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  (void)context;
  return point->tangent[curve->n];
}

/* Locate g between the ends of the curve's step. */
static bool locate(mhb_arclength *curve, mhb_test_function g, void *context, double *fraction) {
  return mhb_arclength_locate(curve, g, context, g(curve, &curve->current, context),
                              g(curve, &curve->next, context), 0, fraction);
}

/* A step on the circle from one angle to another, rad. */
static mhb_arclength *circle_step(double from, double to) {
  mhb_arclength *curve = scalar_curve(scalar_circle, -2, 2);
  curve->current.x[0]  = 4;
  scalar_step(curve, 3 + cos(from), sin(from), 3 + cos(to), sin(to));
  return curve;
}

static double length_of_chord(const mhb_arclength *curve) {
  return hypot(curve->next.x[0] - curve->current.x[0], curve->next.value - curve->current.value);
}

/* Whatever the length of the step, the error is below 1e-9 of it, on the curve, with few calls. */
static void the_error_follows_the_chord(void **state) {
  (void)state;
  for (double step = 0.4; step > 1e-3; step *= 0.5) {
    mhb_arclength *curve = circle_step(0.3, 0.3 + step);
    crossing       c     = {.at = sin(0.3 + 0.37 * step), .bend = 2};
    double         fraction, angle;
    assert_true(locate(curve, crossing_test, &c, &fraction));
    angle = atan2(curve->trial.value, curve->trial.x[0] - 3);
    print_message("step %.1e: error %.1e of it, %d calls\n", step,
                  fabs(curve->trial.value - c.at) / step, c.n);
    assert_near(curve->trial.value, c.at, fmax(2e-9 * length_of_chord(curve), 2e-10));
    assert_near(hypot(curve->trial.x[0] - 3, curve->trial.value), 1, 1e-9);
    assert_near(angle, 0.3 + 0.37 * step, 1e-8);
    assert_near(fraction, 0.37, 0.2 * step);
    assert_true(c.n <= 16);
    mhb_arclength_destroy(curve);
  }
}

/* The trial is linearised there and has its tangent. */
static void the_trial_has_its_tangent(void **state) {
  (void)state;
  mhb_arclength *curve = circle_step(0.3, 0.6);
  crossing       c     = {.at = sin(0.4)};
  double         fraction;
  assert_true(locate(curve, crossing_test, &c, &fraction));
  const double *t = curve->trial.tangent;
  assert_near(t[0] * cos(0.4) + t[1] * sin(0.4), 0, 1e-8);
  assert_true(t[1] > 0);
  assert_near(curve->trial.slope[0], 2 * sin(0.4), 1e-8);
  assert_int_equal(curve->trial.orientation, curve->current.orientation);
  mhb_arclength_destroy(curve);
}

static void a_fold_is_located(void **state) {
  (void)state;
  mhb_arclength *curve = circle_step(1.3, 1.75);
  double         fraction;
  assert_true(locate(curve, fold_test, NULL, &fraction));
  assert_near(curve->trial.value, 1, 1e-12);
  assert_near(curve->trial.x[0], 3, 1e-8);
  mhb_arclength_destroy(curve);
}

/* A test function that jumps has no order: bisection brings the place to 1e-10 of the value. */
static void a_jump_is_located_by_bisection(void **state) {
  (void)state;
  for (int i = 1; i < 8; i++) {
    mhb_arclength *curve = circle_step(0.3, 0.7);
    crossing       c     = {.at = sin(0.3 + 0.05 * i), .jumps = true};
    double         fraction;
    assert_true(locate(curve, crossing_test, &c, &fraction));
    assert_near(curve->trial.value, c.at, 1e-9);
    assert_true(c.n <= 66);
    mhb_arclength_destroy(curve);
  }
}

/* ---- kinks: the law is linear below value 0 ---- */

static bool is_below(const mhb_curve_system *system, const mhb_curve_point *point) {
  (void)system;
  return point->value <= 0;
}

/* In the plane across normal, x = 2 + value solves the linear law; beyond 0 it does not hold. */
static int correct_below(mhb_arclength *curve, const mhb_curve_point *regime, const double *normal,
                         mhb_curve_point *point) {
  double unit = mhb_arclength_unit(curve), scale = curve->parameter_scale;
  double a = normal[0] / (unit * unit), b = normal[1] / (scale * scale);
  if (regime->value > 0) return 0;
  /* a dx + b dvalue = 0 and x + dx = 2 + value + dvalue */
  double dvalue = a * (point->x[0] - 2 - point->value) / (a + b);
  point->value += dvalue;
  point->x[0] = 2 + point->value;
  mhb_arclength_measure(curve, point);
  point->iterations = 0;
  return point->value <= 0;
}

/* A step over the kink, from value low < 0 to high > 0. */
static mhb_arclength *kink_step(double low, double high) {
  mhb_arclength *curve          = scalar_curve(scalar_root_kink, -1, 1);
  curve->system->is_linear      = is_below;
  curve->system->correct_linear = correct_below;
  curve->current.x[0]           = 2;
  scalar_step(curve, 2 + low, low, 2 + high + sqrt(high), high);
  return curve;
}

/* Slope dx/dvalue less 2: it jumps from -1 to +infinity at the kink, and is 0 nowhere near. */
static double slope_test(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  (void)curve;
  (void)context;
  return point->value > 0 ? 0.5 / sqrt(point->value) - 1 : -1;
}

/* The kink is the event. The point is exact, on its linear side, within 2e-7 of the range. */
static void an_event_at_a_kink_is_on_its_linear_side(void **state) {
  (void)state;
  static const double low[] = {-0.01, -1e-3, -0.05}, high[] = {0.02, 1e-4, 1e-3};
  for (int i = 0; i < 3; i++) {
    mhb_arclength *curve = kink_step(low[i], high[i]);
    double         fraction;
    assert_true(locate(curve, slope_test, NULL, &fraction));
    print_message("kink located at %.2e\n", curve->trial.value);
    assert_true(curve->trial.value <= 0);
    assert_near(curve->trial.value, 0, 4e-7);
    assert_true(curve->trial.x[0] == 2 + curve->trial.value);
    mhb_arclength_destroy(curve);
  }
}

/* On either side of a kink events are located as elsewhere. */
static void events_beside_a_kink_are_located(void **state) {
  (void)state;
  static const double at[] = {-0.006, -2e-5, 2e-5, 0.009};
  for (int i = 0; i < 4; i++) {
    mhb_arclength *curve = kink_step(-0.01, 0.02);
    crossing       c     = {.at = at[i]};
    double         fraction;
    assert_true(locate(curve, crossing_test, &c, &fraction));
    print_message("event at %.1e: error %.1e\n", at[i], curve->trial.value - at[i]);
    assert_near(curve->trial.value, at[i], 1e-9);
    mhb_arclength_destroy(curve);
  }
}

/* ---- failures ---- */

/* The line without the middle of the step. */
static double broken(double x, double value, double *f_x, double *f_value) {
  double f = scalar_line(x, value, f_x, f_value);
  return value > 0.1 && value < 0.2 ? NAN : f;
}

static void where_nothing_converges_nothing_is_located(void **state) {
  (void)state;
  mhb_arclength *curve = scalar_curve(broken, 0, 1);
  crossing       c     = {.at = 0.15};
  double         fraction;
  curve->current.x[0] = 2;
  scalar_step(curve, 2, 0, 2.3, 0.3);
  assert_false(locate(curve, crossing_test, &c, &fraction));
  c.at = 0.05; /* beside it all is well */
  assert_true(locate(curve, crossing_test, &c, &fraction));
  assert_near(curve->trial.value, 0.05, 1e-9);
  mhb_arclength_destroy(curve);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_error_follows_the_chord),
                                     cmocka_unit_test(the_trial_has_its_tangent),
                                     cmocka_unit_test(a_fold_is_located),
                                     cmocka_unit_test(a_jump_is_located_by_bisection),
                                     cmocka_unit_test(an_event_at_a_kink_is_on_its_linear_side),
                                     cmocka_unit_test(events_beside_a_kink_are_located),
                                     cmocka_unit_test(where_nothing_converges_nothing_is_located)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
