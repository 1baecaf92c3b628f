/* Pseudo-arclength steps on scalar curves: starts, order of the predictor, ends, excursions. */
#include "mhb/continuation/arclength.h"

#include "mhb/continuation/corrector.h"
#include "tests/support/check.h"
#include "tests/support/scalar_curve.h"

static double on_circle(const mhb_curve_point *p) {
  return hypot(p->x[0] - 3, p->value) - 1;
}

/* ---- starts ---- */

static void a_start_is_a_solution_with_its_sense(void **state) {
  (void)state;
  for (int direction = -1; direction < 2; direction += 2) {
    mhb_arclength *curve = scalar_curve(scalar_circle, -2, 2);
    const double   x     = 3.9;
    assert_int_equal(mhb_arclength_start(curve, &x, 0.6, direction), MHB_CONVERGED);
    assert_true(curve->current.value == 0.6);
    assert_near(curve->current.x[0], 3.8, 1e-9);
    assert_true(curve->current.tangent[1] * direction > 0);
    assert_int_equal(curve->current.orientation, curve->orientation);
    mhb_arclength_destroy(curve);
  }
}

static void a_start_may_fail(void **state) {
  (void)state;
  const double   x     = 2;
  mhb_arclength *curve = scalar_curve(scalar_nowhere, -1, 1);
  assert_int_equal(mhb_arclength_start(curve, &x, 0.2, 1), MHB_MAX_ITERATIONS);
  mhb_arclength_destroy(curve);
  curve = scalar_curve(scalar_cusp, -1, 1);
  assert_int_equal(mhb_arclength_start(curve, &x, 0, 1), MHB_SINGULAR);
  mhb_arclength_destroy(curve);
}

/* x = 3 value + value^2 passes through rest. */
static double through_rest(double x, double value, double *f_x, double *f_value) {
  *f_x     = 1;
  *f_value = -3 - 2 * value;
  return x - 3 * value - value * value;
}

static void at_rest_the_unit_is_the_rate_over_the_range(void **state) {
  (void)state;
  mhb_arclength *curve = scalar_curve(through_rest, 0, 4);
  const double   x     = 0;
  assert_int_equal(mhb_arclength_start(curve, &x, 0, 1), MHB_CONVERGED);
  assert_near(curve->amplitude_at_rest, 12, 1e-12);
  const double *t = curve->current.tangent;
  assert_near(mhb_arclength_inner(curve, 12, t, t), 1, 1e-14);
  mhb_arclength_destroy(curve);
}

/* ---- departures from a crossing ---- */

/* (x - 2)(value - (x - 2)^2) = 0: a pitchfork. */
static double pitchfork(double x, double value, double *f_x, double *f_value) {
  double y = x - 2;
  *f_x     = value - 3 * y * y;
  *f_value = y;
  return y * (value - y * y);
}

static void a_departure_takes_the_other_curve(void **state) {
  (void)state;
  for (int sense = -1; sense < 2; sense += 2) {
    mhb_arclength *curve = scalar_curve(pitchfork, -1, 1);
    const double   x = 2, along = 0.3 * sense;
    assert_int_equal(mhb_arclength_depart(curve, &x, 0, &along), MHB_CONVERGED);
    double y = curve->current.x[0] - 2;
    assert_near(curve->current.value, y * y, 1e-8);
    assert_true(y * sense > 0.0005 * 2 && y * sense < 0.06 * 2);
    assert_int_equal(curve->orientation, curve->current.orientation);
    mhb_arclength_destroy(curve);
  }
}

static double vertical_line(double x, double value, double *f_x, double *f_value) {
  (void)value;
  *f_x     = 1;
  *f_value = 0;
  return x - 2;
}

static void without_another_curve_there_is_no_departure(void **state) {
  (void)state;
  mhb_arclength *curve = scalar_curve(vertical_line, -1, 1);
  const double   x = 2, along = 1;
  assert_int_equal(mhb_arclength_depart(curve, &x, 0, &along), MHB_NO_DESCENT);
  mhb_arclength_destroy(curve);
}

/* ---- steps ---- */

/* The predictor follows the tangent: its error is of second order in the step. */
static void the_predictor_is_of_second_order(void **state) {
  (void)state;
  double error[5];
  for (int i = 0; i < 5; i++) {
    mhb_arclength *curve = scalar_curve(scalar_circle, -2, 2);
    const double   x = 3.8, h = 0.02 / (1 << i);
    assert_int_equal(mhb_arclength_start(curve, &x, 0.6, 1), MHB_CONVERGED);
    curve->step = h;
    assert_int_equal(mhb_arclength_step(curve), MHB_ARCLENGTH_ON);
    const mhb_curve_point *a = &curve->current, *b = &curve->next;
    double dx = b->x[0] - a->x[0] - h * a->tangent[0], dv = b->value - a->value - h * a->tangent[1];
    error[i] = hypot(dx, dv);
    mhb_arclength_destroy(curve);
  }
  for (int i = 1; i < 5; i++) {
    double order = log2(error[i - 1] / error[i]);
    print_message("predictor error %.2e, order %.3f\n", error[i], order);
    assert_near(order, 2, 0.1);
  }
}

/* Residual of the first point that a step linearises: that of the prediction. */
static void (*linearise_curve)(mhb_curve_system *system, mhb_curve_point *point);
static double of_prediction;

static void linearise_and_note(mhb_curve_system *system, mhb_curve_point *point) {
  linearise_curve(system, point);
  if (isnan(of_prediction)) of_prediction = fabs(point->r[0]);
}

/* x = exp(value), of no symmetry. */
static double exponential(double x, double value, double *f_x, double *f_value) {
  *f_x     = 1;
  *f_value = -exp(value);
  return x - exp(value);
}

/* The residual of the prediction of the second of two steps of length h. */
static double predicted(double h, bool bends) {
  mhb_arclength *curve     = scalar_curve(exponential, -2, 2);
  const double   x         = exp(0.3);
  linearise_curve          = curve->system->linearise;
  curve->system->linearise = linearise_and_note;
  curve->system->bends     = bends;
  assert_int_equal(mhb_arclength_start(curve, &x, 0.3, 1), MHB_CONVERGED);
  for (int step = 0; step < 2; step++) {
    of_prediction = NAN;
    curve->step   = h;
    assert_int_equal(mhb_arclength_step(curve), MHB_ARCLENGTH_ON);
    mhb_arclength_advance(curve);
  }
  mhb_arclength_destroy(curve);
  return of_prediction;
}

/* With the curvature of the step before the error of the prediction is of third order, along the
 * tangent alone of second. */
static void a_bent_prediction_is_of_third_order(void **state) {
  (void)state;
  for (int bends = 0; bends < 2; bends++)
    for (double h = 0.04; h > 0.003; h /= 2) {
      const double error = predicted(h, bends), order = log2(error / predicted(h / 2, bends));
      print_message("%s: error %.2e, order %.3f\n", bends ? "parabola" : "tangent", error, order);
      assert_near(order, 2 + bends, 0.1);
    }
}

/* Round the circle: every point lies on it, steps are bounded, and the orientation is constant. */
static void steps_go_round(void **state) {
  (void)state;
  mhb_arclength *curve = scalar_curve(scalar_circle, -2, 2);
  const double   x     = 3.8;
  double         angle = 0;
  int            n     = 0;
  assert_int_equal(mhb_arclength_start(curve, &x, 0.6, 1), MHB_CONVERGED);
  for (; angle < 6.2831853 && n < 500; n++) {
    assert_int_equal(mhb_arclength_step(curve), MHB_ARCLENGTH_ON);
    const mhb_curve_point *a = &curve->current, *b = &curve->next;
    const double           chord[] = {b->x[0] - a->x[0], b->value - a->value};
    double                 unit    = mhb_arclength_unit(curve);
    double                 length  = sqrt(mhb_arclength_inner(curve, unit, chord, chord));
    double                 turn    = atan2(b->value, b->x[0] - 3) - atan2(a->value, a->x[0] - 3);
    assert_small(on_circle(b), 1e-8);
    assert_below(length, 1.1 * curve->longest);
    assert_int_equal(b->orientation, curve->orientation);
    if (turn < -3) turn += 6.283185307179586;
    assert_true(turn > 0);
    angle += turn;
    mhb_arclength_advance(curve);
  }
  print_message("circle: %d steps\n", n);
  assert_true(n > 20 && n < 100);
  mhb_arclength_destroy(curve);
}

static void the_last_step_ends_on_the_range(void **state) {
  (void)state;
  for (int direction = -1; direction < 2; direction += 2) {
    mhb_arclength        *curve = scalar_curve(scalar_line, -0.1, 0.1);
    const double          x     = 2;
    mhb_arclength_outcome outcome;
    assert_int_equal(mhb_arclength_start(curve, &x, 0, direction), MHB_CONVERGED);
    while ((outcome = mhb_arclength_step(curve)) == MHB_ARCLENGTH_ON) mhb_arclength_advance(curve);
    assert_int_equal(outcome, direction > 0 ? MHB_ARCLENGTH_AT_END : MHB_ARCLENGTH_AT_START);
    assert_true(curve->next.value == 0.1 * direction);
    assert_near(curve->next.x[0], 2 + 0.1 * direction, 1e-9);
    mhb_arclength_destroy(curve);
  }
}

/* The line, which ends at value 0.3. */
static double ends(double x, double value, double *f_x, double *f_value) {
  double f = scalar_line(x, value, f_x, f_value);
  return value <= 0.3 ? f : NAN;
}

static void where_the_curve_ends_the_step_stalls(void **state) {
  (void)state;
  mhb_arclength        *curve = scalar_curve(ends, 0, 1);
  const double          x     = 2;
  mhb_arclength_outcome outcome;
  int                   n = 0;
  assert_int_equal(mhb_arclength_start(curve, &x, 0, 1), MHB_CONVERGED);
  for (; (outcome = mhb_arclength_step(curve)) == MHB_ARCLENGTH_ON && n < 1000; n++)
    mhb_arclength_advance(curve);
  print_message("%d steps, last at %.6f\n", n, curve->current.value);
  assert_int_equal(outcome, MHB_ARCLENGTH_STALLED);
  assert_near(curve->current.value, 0.3, 1e-3);
  mhb_arclength_destroy(curve);
}

/* ---- what a system may ask of the steps ---- */

static double limit_of_step(const mhb_curve_system *system, double value, int direction) {
  (void)system;
  (void)value;
  return direction > 0 ? 0.003 : INFINITY;
}

static int n_skipped;

static bool skipped_twice(mhb_arclength *curve) {
  (void)curve;
  return n_skipped++ < 2;
}

static void a_step_keeps_the_limit_of_the_resonances(void **state) {
  (void)state;
  mhb_arclength *curve = scalar_curve(scalar_line, 0, 1);
  const double   x     = 2;
  assert_int_equal(mhb_arclength_start(curve, &x, 0, 1), MHB_CONVERGED);
  curve->system->resonance_step_limit = limit_of_step;
  curve->system->resonance_skipped    = skipped_twice;
  n_skipped                           = 0;
  assert_int_equal(mhb_arclength_step(curve), MHB_ARCLENGTH_ON);
  assert_int_equal(n_skipped, 3); /* repeated until nothing is skipped */
  assert_near(curve->next.value, 0.003, 1e-9);
  mhb_arclength_destroy(curve);
}

static double tenth(const mhb_curve_system *system, const mhb_curve_point *point) {
  (void)system;
  (void)point;
  return 0.1;
}

static void the_unit_of_the_value_may_follow_the_curve(void **state) {
  (void)state;
  mhb_arclength *curve = scalar_curve(scalar_line, 0, 1);
  const double   x     = 2;
  assert_int_equal(mhb_arclength_start(curve, &x, 0, 1), MHB_CONVERGED);
  curve->system->unit_of_value = tenth;
  assert_int_equal(mhb_arclength_step(curve), MHB_ARCLENGTH_ON);
  const double *t = curve->current.tangent;
  assert_true(curve->parameter_scale == 0.1);
  assert_near(mhb_arclength_inner(curve, mhb_arclength_unit(curve), t, t), 1, 1e-14);
  mhb_arclength_destroy(curve);
}

/* ---- outside the range ---- */

static void an_excursion_comes_back_or_not(void **state) {
  (void)state;
  mhb_arclength *curve   = scalar_curve(scalar_circle, -2, 0.8);
  const double   x       = 3.6;
  double         longest = curve->longest;
  assert_int_equal(mhb_arclength_start(curve, &x, 0.8, 1), MHB_CONVERGED);
  assert_true(mhb_arclength_excursion(curve, 1, MHB_EXCURSION_FAR));
  assert_true(curve->next.value == 0.8 && curve->next.tangent[1] < 0);
  assert_near(curve->next.x[0], 2.4, 1e-9);
  assert_true(curve->low == -2 && curve->high == 0.8 && curve->longest == longest);
  mhb_arclength_destroy(curve);

  const double start[] = {3, 1};
  for (int end = -1; end < 2; end += 2)
    for (int reach = 0; reach < 2; reach++) {
      curve = scalar_curve(scalar_line, -1, 1);
      assert_int_equal(mhb_arclength_start(curve, &start[end < 0], end, end), MHB_CONVERGED);
      assert_false(
          mhb_arclength_excursion(curve, end, reach ? MHB_EXCURSION_NEAR : MHB_EXCURSION_FAR));
      assert_true(curve->low == -1 && curve->high == 1 && curve->longest == longest);
      mhb_arclength_destroy(curve);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_start_is_a_solution_with_its_sense),
                                     cmocka_unit_test(a_start_may_fail),
                                     cmocka_unit_test(at_rest_the_unit_is_the_rate_over_the_range),
                                     cmocka_unit_test(a_departure_takes_the_other_curve),
                                     cmocka_unit_test(without_another_curve_there_is_no_departure),
                                     cmocka_unit_test(the_predictor_is_of_second_order),
                                     cmocka_unit_test(a_bent_prediction_is_of_third_order),
                                     cmocka_unit_test(steps_go_round),
                                     cmocka_unit_test(the_last_step_ends_on_the_range),
                                     cmocka_unit_test(where_the_curve_ends_the_step_stalls),
                                     cmocka_unit_test(a_step_keeps_the_limit_of_the_resonances),
                                     cmocka_unit_test(the_unit_of_the_value_may_follow_the_curve),
                                     cmocka_unit_test(an_excursion_comes_back_or_not)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
