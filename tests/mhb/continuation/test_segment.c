/* mhb_trace_segment on scalar problems, without a contact law: circle, cusp, square-root kink.
 * Closed curves, ends of the range, and every end that a segment can have. */
#include "mesh/base/constants.h"
#include "mhb/continuation/segment.h"

#include <math.h>

#include "mhb/response/response.h"
#include "tests/support/check.h"
#include "tests/support/scalar_curve.h"

/* ---- a host that records the points ---- */

enum { ROOM = 2000 };

typedef struct {
  mhb_segment_host host;
  mhb_event_test   test[4];
  mhb_events       events;
  mhb_curve_place  start;
  mhb_curve_return back;
  int              n, stop_at, special[ROOM];
  double           x[ROOM], value[ROOM], residual;
} tracing;

static shb_status estimate(mhb_segment_host *host, mhb_curve_point *point, bool *raised) {
  (void)host;
  (void)point;
  *raised = false;
  return SHB_OK;
}

static void estimate_event(mhb_segment_host *host, mhb_curve_point *point) {
  (void)host;
  (void)point;
}

static shb_status accept(mhb_segment_host *host, bool *moved) {
  (void)host;
  *moved = false;
  return SHB_OK;
}

static shb_status started(mhb_segment_host *host, const mhb_seed *seed, mhb_end *end) {
  tracing *t = (tracing *)host;
  (void)seed;
  (void)end;
  t->back = (mhb_curve_return){&t->start, 0};
  mhb_curve_place_note(&t->start, host->curve->system, &host->curve->current, 1e-6);
  return SHB_OK;
}

static shb_status record(mhb_segment_host *host, mhb_curve_point *point, int special, bool *go_on) {
  tracing *t = (tracing *)host;
  assert_true(t->n < ROOM);
  t->special[t->n] = special;
  t->x[t->n]       = point->x[0];
  t->value[t->n++] = point->value;
  t->residual      = fmax(t->residual, point->residual);
  *go_on           = t->n != t->stop_at;
  return SHB_OK;
}

static double beyond(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  double end = *(const int *)context;
  return end > 0 ? point->value - curve->high : curve->low - point->value;
}

static const int HIGH = 1, LOW = -1;

/* Trace a curve from x at a value. The caller frees it by finish. */
static mhb_end trace(tracing *t, scalar_function f, double low, double high, double x, double value,
                     int direction, int max_points) {
  mhb_end  end;
  int      stop_at = t->stop_at;
  mhb_seed seed    = {.x = &x, .value = value, .direction = direction};
  *t               = (tracing){.stop_at = stop_at};
  t->host.curve    = scalar_curve(f, low, high);
  t->test[0]       = (mhb_event_test){.name      = "closed",
                                      .g         = mhb_curve_return_ahead,
                                      .context   = &t->back,
                                      .direction = 1,
                                      .is_near   = mhb_curve_return_is_near,
                                      .accept    = mhb_curve_return_arrived,
                                      .end       = MHB_END_CLOSED};
  t->test[1]       = (mhb_event_test){.name      = "high",
                                      .g         = beyond,
                                      .context   = (void *)&HIGH,
                                      .direction = 1,
                                      .at_next   = true,
                                      .end       = MHB_END_HIGH};
  t->test[2]       = (mhb_event_test){.name      = "low",
                                      .g         = beyond,
                                      .context   = (void *)&LOW,
                                      .direction = 1,
                                      .at_next   = true,
                                      .end       = MHB_END_LOW};
  t->test[3]       = (mhb_event_test){.name = "fold", .g = mhb_fold_test, .special = MHB_FOLD};
  t->host          = (mhb_segment_host){.curve          = t->host.curve,
                                        .n_tests        = 4,
                                        .test           = t->test,
                                        .events         = &t->events,
                                        .max_points     = max_points,
                                        .estimate       = estimate,
                                        .estimate_event = estimate_event,
                                        .accept         = accept,
                                        .started        = started,
                                        .record         = record};
  assert_ok(mhb_trace_segment(&t->host, &seed, &end));
  return end;
}

static void finish(tracing *t) {
  mhb_events_destroy(&t->events);
  mhb_curve_place_free(&t->start);
  mhb_arclength_destroy(t->host.curve);
}

static int folds(const tracing *t, double *value, double *x) {
  int n = 0;
  for (int i = 0; i < t->n; i++)
    if (t->special[i] == MHB_FOLD) {
      value[n] = t->value[i];
      x[n++]   = t->x[i];
      assert_true(n < 8);
    }
  return n;
}

/* ---- the curves ---- */

static void a_circle_is_closed_with_two_folds(void **state) {
  (void)state;
  tracing t = {0};
  double  value[8], x[8];
  for (int direction = -1; direction < 2; direction += 2) {
    assert_int_equal(trace(&t, scalar_circle, -2, 2, 3.8, 0.6, direction, 500), MHB_END_CLOSED);
    assert_int_equal(folds(&t, value, x), 2);
    print_message("circle: %d points, folds %.12f %.12f\n", t.n, value[0], value[1]);
    for (int i = 0; i < 2; i++) {
      assert_near(fabs(value[i]), 1, 1e-9);
      assert_near(x[i], 3, 1e-4); /* the root of the above */
    }
    assert_true(value[0] * direction > 0 && value[1] * direction < 0);
    assert_near(t.value[t.n - 1], 0.6, 1e-6); /* the last point is the first */
    assert_near(t.x[t.n - 1], 3.8, 1e-6);
    assert_true(t.residual <= 1e-10);
    finish(&t);
  }
}

/* In a range that cuts the circle the segment ends exactly on either end of it. */
static void a_cut_circle_ends_on_the_range(void **state) {
  (void)state;
  tracing t = {0};
  double  value[8], x[8];
  assert_int_equal(trace(&t, scalar_circle, -2, 0.7, 3.8, 0.6, 1, 500), MHB_END_HIGH);
  assert_true(t.value[t.n - 1] == 0.7);
  assert_near(t.x[t.n - 1], 3 + sqrt(1 - 0.49), 1e-10);
  finish(&t);
  assert_int_equal(trace(&t, scalar_circle, -0.3, 2, 3.8, 0.6, 1, 500), MHB_END_LOW);
  assert_true(t.value[t.n - 1] == -0.3); /* over the fold and down the other side */
  assert_near(t.x[t.n - 1], 3 - sqrt(1 - 0.09), 1e-10);
  assert_int_equal(folds(&t, value, x), 1);
  finish(&t);
}

/* Cubic x^3 - 0.3 x + value = 0 about x = 0, moved to x = 2: two folds at value = +-2 (0.1)^1.5. */
static double s_curve(double x, double value, double *f_x, double *f_value) {
  double y = x - 2;
  *f_x     = -3 * y * y + 0.3;
  *f_value = 1;
  return -y * y * y + 0.3 * y + value;
}

static void an_s_curve_is_passed_from_end_to_end(void **state) {
  (void)state;
  tracing      t    = {0};
  const double fold = 2 * pow(0.1, 1.5);
  double       value[8], x[8];
  assert_int_equal(trace(&t, s_curve, -1, 1, 1, -1, 1, 500), MHB_END_HIGH);
  assert_int_equal(folds(&t, value, x), 2);
  print_message("s curve: %d points, folds %.12f %.12f\n", t.n, value[0], value[1]);
  assert_near(value[0], fold, 1e-9);
  assert_near(value[1], -fold, 1e-9);
  assert_near(x[0], 2 - sqrt(0.1), 1e-4);
  assert_near(x[1], 2 + sqrt(0.1), 1e-4);
  finish(&t);
}

/* No tangent exists at a cusp. The segment passes it, or ends with its reason; what it recorded
 * solves the equation. */
static void a_cusp_ends_or_is_passed(void **state) {
  (void)state;
  tracing t   = {0};
  mhb_end end = trace(&t, scalar_cusp, -1, 1, 2 + pow(0.8, 2. / 3), -0.8, 1, 500);
  print_message("cusp: %d points, %s at value %.3g\n", t.n, mhb_end_text(end), t.value[t.n - 1]);
  assert_true(end == MHB_END_HIGH || end == MHB_END_STALLED || end == MHB_END_TINY_STEPS);
  assert_true(t.n > 10);
  for (int i = 0; i < t.n; i++) assert_near(t.value[i] * t.value[i], pow(t.x[i] - 2, 3), 1e-8);
  finish(&t);
}

static void a_square_root_kink_is_passed(void **state) {
  (void)state;
  tracing t = {0};
  for (int direction = -1; direction < 2; direction += 2) {
    double from = direction > 0 ? -0.5 : 0.5, x = direction > 0 ? 1.5 : 2.5 + sqrt(0.5);
    assert_int_equal(trace(&t, scalar_root_kink, -0.5, 0.5, x, from, direction, 500),
                     direction > 0 ? MHB_END_HIGH : MHB_END_LOW);
    print_message("square-root kink: %d points\n", t.n);
    for (int i = 0; i < t.n; i++) {
      double wanted = 2 + t.value[i] + (t.value[i] > 0 ? sqrt(t.value[i]) : 0);
      assert_near(t.x[i], wanted, 1e-8);
    }
    finish(&t);
  }
}

/* x = 2 + |value|: a kink without a fold. */
static double kink(double x, double value, double *f_x, double *f_value) {
  *f_x     = 1;
  *f_value = value < 0 ? 1 : -1;
  return x - 2 - fabs(value);
}

static void a_kink_is_no_fold(void **state) {
  (void)state;
  tracing t = {0};
  double  value[8], x[8];
  assert_int_equal(trace(&t, kink, -0.5, 0.5, 2.5, -0.5, 1, 500), MHB_END_HIGH);
  assert_int_equal(folds(&t, value, x), 0);
  finish(&t);
}

/* value = y + 0.15 sin(20 y), y = x - 0.6: a snake of folds where 1 + 3 cos(20 y) = 0. */
static double snake(double x, double value, double *f_x, double *f_value) {
  double y = x - 0.6;
  *f_x     = -1 - 3 * cos(20 * y);
  *f_value = 1;
  return value - y - 0.15 * sin(20 * y);
}

static void all_folds_of_a_snake_are_found(void **state) {
  (void)state;
  tracing      t     = {0};
  const double inner = acos(-1. / 3) / 20, outer = SHB_TWO_PI / 20 - inner;
  const double wanted[] = {-outer, -inner, inner, outer};
  double       value[8], x[8];
  assert_int_equal(trace(&t, snake, -0.31, 0.31, 0.6 - 0.313, -0.31, 1, 500), MHB_END_HIGH);
  assert_int_equal(folds(&t, value, x), 4);
  print_message("snake: %d points\n", t.n);
  for (int i = 0; i < 4; i++) assert_near(x[i], 0.6 + wanted[i], 1e-5);
  finish(&t);
}

/* ---- other ends ---- */

static void a_segment_of_too_many_points_says_so(void **state) {
  (void)state;
  tracing t = {0};
  assert_int_equal(trace(&t, scalar_circle, -2, 2, 3.8, 0.6, 1, 7), MHB_END_MAX_POINTS);
  assert_true(t.n >= 7 && t.n <= 8);
  finish(&t);
}

static void a_segment_can_be_interrupted(void **state) {
  (void)state;
  tracing t = {.stop_at = 5};
  assert_int_equal(trace(&t, scalar_circle, -2, 2, 3.8, 0.6, 1, 500), MHB_END_INTERRUPTED);
  assert_int_equal(t.n, 5);
  finish(&t);
}

static void without_a_solution_there_is_no_start(void **state) {
  (void)state;
  tracing t = {0};
  assert_int_equal(trace(&t, scalar_nowhere, -1, 1, 0.3, 0, 1, 500), MHB_END_NO_START);
  assert_int_equal(t.n, 0);
  finish(&t);
}

/* ln(0.5 - value) + x - 2 = 0 runs to infinity before the range ends. */
static double to_infinity(double x, double value, double *f_x, double *f_value) {
  *f_x     = 1;
  *f_value = -1 / (0.5 - value);
  return value < 0.5 ? log(0.5 - value) + x - 2 : NAN;
}

static void a_curve_that_runs_to_infinity_ends(void **state) {
  (void)state;
  tracing t   = {0};
  mhb_end end = trace(&t, to_infinity, -1, 1, 2 - log(1.5), -1, 1, 300);
  print_message("to infinity: %d points, %s\n", t.n, mhb_end_text(end));
  assert_true(end == MHB_END_MAX_POINTS || end == MHB_END_STALLED || end == MHB_END_TINY_STEPS);
  assert_true(t.value[t.n - 1] < 0.5);
  finish(&t);
}

/* A segment from the low end outwards comes back where the circle does: at its other side. */
static void an_excursion_comes_back(void **state) {
  (void)state;
  tracing  t = {0};
  mhb_end  end;
  double   x    = 3 + sqrt(1 - 0.16);
  mhb_seed seed = {.kind      = MHB_SEED_EXCURSION,
                   .x         = &x,
                   .value     = 0.4,
                   .direction = 1,
                   .reach     = MHB_EXCURSION_FAR};
  trace(&t, scalar_circle, -2, 0.4, x, 0.4, -1, 2); /* for its host */
  t.n               = 0;
  t.host.max_points = 400;
  assert_ok(mhb_trace_segment(&t.host, &seed, &end));
  print_message("excursion: first x %.12f\n", t.x[0]);
  assert_true(t.value[0] == 0.4);
  assert_near(t.x[0], 3 - sqrt(1 - 0.16), 1e-10);
  assert_int_equal(end, MHB_END_HIGH);
  assert_near(t.x[t.n - 1], x, 1e-10); /* round the circle, back to where it left */
  finish(&t);
}

/* Points that the host has already do not count: max_points of them are recorded. */
static void a_first_point_that_is_known_does_not_count(void **state) {
  (void)state;
  tracing  t = {0};
  mhb_end  end;
  double   x    = 3 + sqrt(1 - 0.16);
  mhb_seed seed = {.x = &x, .value = 0.4, .direction = 1, .skip_first = true};
  trace(&t, scalar_circle, -2, 2, x, 0.4, 1, 2); /* for its host */
  t.n               = 0;
  t.host.max_points = 5;
  assert_ok(mhb_trace_segment(&t.host, &seed, &end));
  assert_int_equal(end, MHB_END_MAX_POINTS);
  assert_int_equal(t.n, 5);
  finish(&t);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_circle_is_closed_with_two_folds),
                                     cmocka_unit_test(a_cut_circle_ends_on_the_range),
                                     cmocka_unit_test(an_s_curve_is_passed_from_end_to_end),
                                     cmocka_unit_test(a_cusp_ends_or_is_passed),
                                     cmocka_unit_test(a_square_root_kink_is_passed),
                                     cmocka_unit_test(a_kink_is_no_fold),
                                     cmocka_unit_test(all_folds_of_a_snake_are_found),
                                     cmocka_unit_test(a_segment_of_too_many_points_says_so),
                                     cmocka_unit_test(a_segment_can_be_interrupted),
                                     cmocka_unit_test(without_a_solution_there_is_no_start),
                                     cmocka_unit_test(a_curve_that_runs_to_infinity_ends),
                                     cmocka_unit_test(an_excursion_comes_back),
                                     cmocka_unit_test(a_first_point_that_is_known_does_not_count)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
