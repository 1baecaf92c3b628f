/* The tracer on a small blade: segments from end to end, what it records, and how it stops. */
#include "mhb/branches/tracer.h"

#include "mesh/base/constants.h"
#include "mhb/continuation/outputs.h"
#include "tests/support/check.h"
#include "tests/support/quiet_monitor.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { H = 3, N = 3 * (2 * H + 1) };

typedef struct {
  modal_model   model;
  mhb_settings  settings;
  mhb_balance  *balance;
  mhb_response *response;
  mhb_tracer   *tracer;
  quiet_monitor monitor;
  double        x[N], low, high; /* stuck limit at the low end; rad/s */
} fixture;

/* A resonance of the stuck blade with slip at its top. */
static void set_up(fixture *f, int stop_at) {
  one_degree_model(0.02, 1, 0.1, &f->model);
  f->settings              = ground_settings(0.3, 1, 0.5, 0.3, H);
  f->settings.frequency[0] = 0.16;
  f->settings.frequency[1] = 0.24;
  f->settings.stability    = MHB_STABILITY_NEVER;
  f->low                   = SHB_TWO_PI * 0.16;
  f->high                  = SHB_TWO_PI * 0.24;
  f->monitor               = quiet_monitor_create(stop_at);
  assert_ok(mhb_balance_create(&f->model, &f->settings, &f->balance));
  mhb_balance_set_preload(f->balance, 0.3);
  f->response = mhb_response_create(1, 1, H);
  assert_non_null(f->response);
  mhb_response_branch(f->response, MHB_BRANCH_NONLINEAR);
  assert_ok(mhb_tracer_create(f->balance, f->response, 0, false, &f->monitor.base, &f->tracer));
  assert_ok(mhb_balance_linear_limit(f->balance, f->low, 1, f->x));
}

static void tear_down(fixture *f) {
  mhb_tracer_destroy(f->tracer);
  mhb_response_destroy(f->response);
  mhb_balance_destroy(f->balance);
  modal_model_free(&f->model);
}

static mhb_segment_plan upwards(const fixture *f) {
  return (mhb_segment_plan){.seed = {.x = f->x, .value = f->low, .direction = 1}, .m = H};
}

static void a_segment_runs_from_end_to_end(void **state) {
  (void)state;
  fixture f;
  int     segment, n_peaks = 0, n_slipping = 0;
  mhb_end end;
  set_up(&f, 0);
  assert_true(f.tracer->farthest == f.low);
  mhb_segment_plan plan = upwards(&f);
  assert_ok(mhb_tracer_trace(f.tracer, &plan, &segment, &end));
  assert_int_equal(end, MHB_END_HIGH);
  const mhb_branch *b = &f.tracer->store->branch[segment];
  assert_near(b->value[0], 0.16, 1e-15);
  assert_near(b->value[b->n_points - 1], 0.24, 1e-15);
  assert_near(f.tracer->farthest, f.high, 1e-12);
  assert_int_equal(f.monitor.n_points, b->n_points);
  for (int i = 0; i < b->n_points; i++) {
    assert_below(b->error_newton[i], 1e-8);
    assert_int_equal(b->harmonics[i], H);
    n_peaks += b->special[i] == MHB_PEAK;
    n_slipping += b->state[3 * i + 1] > 0;
  }
  print_message("%d points, %d peaks, %d with slip\n", b->n_points, n_peaks, n_slipping);
  assert_true(n_peaks > 0 && n_slipping > 0 && n_slipping < b->n_points);
  tear_down(&f);
}

/* At a recorded peak the amplitude of the probe is above that of both neighbours, each recorded at
 * its own frequency. */
static void peaks_are_local_maxima(void **state) {
  (void)state;
  fixture f;
  int     segment, seen = 0;
  mhb_end end;
  set_up(&f, 0);
  mhb_segment_plan plan = upwards(&f);
  assert_ok(mhb_tracer_trace(f.tracer, &plan, &segment, &end));
  const mhb_branch *b = &f.tracer->store->branch[segment];
  for (int i = 1; i + 1 < b->n_points; i++) {
    if (b->special[i] != MHB_PEAK) continue;
    double a[3];
    for (int k = 0; k < 3; k++) {
      const double complex *q = b->probe + 3 * (i + k - 1) * (H + 1) + 1;
      a[k] = pow(cabs(q[0]), 2) + pow(cabs(q[H + 1]), 2) + pow(cabs(q[2 * (H + 1)]), 2);
    }
    seen += a[1] >= a[0] && a[1] >= a[2];
  }
  assert_true(seen > 0);
  tear_down(&f);
}

/* A motion of twice the period whose odd harmonics are round-off has the period itself. The segment
 * joins the curve of lower order at once, whatever sign the rate of the round-off has. */
static void round_off_is_no_part_of_higher_order(void **state) {
  (void)state;
  double x[3 * (4 * H + 1)];
  for (int sign = -1; sign <= 1; sign++) {
    fixture f;
    int     segment;
    mhb_end end;
    set_up(&f, 0);
    mhb_tracer_destroy(f.tracer);
    mhb_balance_destroy(f.balance);
    mhb_response_destroy(f.response);
    f.settings.subharmonics = 2;
    f.settings.harmonics    = 2 * H;
    assert_ok(mhb_balance_create(&f.model, &f.settings, &f.balance));
    mhb_balance_set_preload(f.balance, 0.3);
    f.response = mhb_response_create(1, 1, 2 * H);
    assert_non_null(f.response);
    mhb_response_branch(f.response, MHB_BRANCH_NONLINEAR);
    assert_ok(mhb_tracer_create(f.balance, f.response, 0, true, &f.monitor.base, &f.tracer));
    assert_ok(mhb_balance_linear_limit(f.balance, f.low, 1, x));
    x[1] = x[2]           = sign * 1e-16 * x[4];
    mhb_segment_plan plan = {.seed = {.x = x, .value = f.low, .direction = 1}, .m = 2 * H};
    assert_ok(mhb_tracer_trace(f.tracer, &plan, &segment, &end));
    assert_int_equal(end, MHB_END_JOINED);
    assert_int_equal(f.tracer->store->branch[segment].n_points, 2);
    tear_down(&f);
  }
}

/* Every recorded point solves the balance that recorded it. */
static void recorded_points_are_solutions(void **state) {
  (void)state;
  fixture f;
  int     segment;
  mhb_end end;
  double  x[N], r[N];
  set_up(&f, 0);
  mhb_segment_plan plan = upwards(&f);
  assert_ok(mhb_tracer_trace(f.tracer, &plan, &segment, &end));
  const mhb_branch *b = &f.tracer->store->branch[segment];
  for (int i = 0; i < b->n_points; i += 5) {
    assert_ok(mhb_tracer_recorded(f.tracer, segment, i, x));
    mhb_balance *balance = mhb_tracer_balance(f.tracer);
    mhb_balance_use(balance, NULL);
    mhb_balance_evaluate(balance, x, SHB_TWO_PI * b->value[i], r, NULL, NULL);
    assert_below(mhb_norm(r, N), 1e-8 * mhb_norm(x, N));
  }
  tear_down(&f);
}

/* Down from the last point of a segment: a second segment with the same points the other way. */
static void a_segment_may_be_traced_back(void **state) {
  (void)state;
  fixture f;
  int     up, down, point;
  mhb_end end;
  double  x[N];
  set_up(&f, 0);
  mhb_segment_plan plan = upwards(&f);
  assert_ok(mhb_tracer_trace(f.tracer, &plan, &up, &end));
  point = f.tracer->store->branch[up].n_points - 1;
  assert_ok(mhb_tracer_recorded(f.tracer, up, point, x));
  plan.seed = (mhb_seed){.x = x, .value = f.high, .direction = -1, .skip_first = true};
  assert_ok(mhb_tracer_trace(f.tracer, &plan, &down, &end));
  assert_int_equal(end, MHB_END_LOW);
  const mhb_branch *a = &f.tracer->store->branch[up], *b = &f.tracer->store->branch[down];
  assert_true(b->value[0] < 0.24); /* the first point is in the other segment */
  double first = cabs(a->motion[1 * (H + 1) + 1]);
  double last  = cabs(b->motion[(3 * (b->n_points - 1) + 1) * (H + 1) + 1]);
  assert_near(last, first, 1e-8 * first);
  mhb_tracer_forget(f.tracer, down);
  assert_int_equal(f.tracer->store->branch[down].n_points, 0);
  assert_true(a->n_points > 0);
  tear_down(&f);
}

static void the_monitor_stops_it(void **state) {
  (void)state;
  fixture f;
  int     segment;
  mhb_end end;
  set_up(&f, 6);
  mhb_segment_plan plan = upwards(&f);
  assert_ok(mhb_tracer_trace(f.tracer, &plan, &segment, &end));
  assert_int_equal(end, MHB_END_INTERRUPTED);
  assert_int_equal(f.tracer->store->branch[segment].n_points, 6);
  tear_down(&f);
}

/* The points of a branch are limited, those of its earlier segments included. Segments of other
 * branches do not count. */
static void points_of_a_branch_are_limited(void **state) {
  (void)state;
  fixture f;
  int     segment;
  mhb_end end;
  set_up(&f, 0);
  f.settings.max_points = 10;
  mhb_segment_plan plan = upwards(&f);
  assert_ok(mhb_tracer_trace(f.tracer, &plan, &segment, &end));
  assert_int_equal(end, MHB_END_MAX_POINTS);
  int n = f.tracer->store->branch[segment].n_points;
  assert_true(n >= 10 && n < 10 + 4);
  assert_ok(mhb_tracer_trace(f.tracer, &plan, &segment, &end));
  assert_int_equal(f.tracer->store->branch[segment].n_points, n);
  plan.recorded = n;
  assert_ok(mhb_tracer_trace(f.tracer, &plan, &segment, &end));
  assert_int_equal(end, MHB_END_MAX_POINTS);
  assert_int_equal(f.tracer->store->branch[segment].n_points, 1);
  tear_down(&f);
}

/* A seed that leads nowhere leaves a segment without points. */
static void without_a_solution_there_is_no_segment(void **state) {
  (void)state;
  fixture f;
  int     segment;
  mhb_end end;
  set_up(&f, 0);
  for (int i = 0; i < N; i++) f.x[i] = NAN;
  mhb_segment_plan plan = upwards(&f);
  assert_ok(mhb_tracer_trace(f.tracer, &plan, &segment, &end));
  assert_int_equal(end, MHB_END_NO_START);
  assert_int_equal(f.tracer->store->branch[segment].n_points, 0);
  tear_down(&f);
}

/* ---- targets and publication ---- */

/* A place noted on the way is a target: the segment ends there, and not at the end of the range. */
static void a_segment_ends_at_its_target(void **state) {
  (void)state;
  fixture         f;
  int             segment;
  mhb_end         end;
  mhb_curve_place place = {0};
  set_up(&f, 9);
  mhb_segment_plan plan = upwards(&f);
  assert_ok(mhb_tracer_trace(f.tracer, &plan, &segment, &end));
  mhb_arclength *curve = mhb_tracer_curve(f.tracer);
  double         value = curve->current.value;
  mhb_curve_place_note(&place, curve->system, &curve->current, mhb_tracer_same(f.tracer));
  plan.target = &place;
  assert_ok(mhb_tracer_trace(f.tracer, &plan, &segment, &end));
  print_message("target at %.6f rad/s, %d points\n", value,
                f.tracer->store->branch[segment].n_points);
  assert_int_equal(end, MHB_END_CLOSED);
  assert_near(curve->current.value, value, 1e-4);
  mhb_curve_place_free(&place);
  tear_down(&f);
}

static shb_status count(void *context) {
  int *n = context;
  if (++*n == 5) SHB_FAIL(SHB_ERR_IO, "the disk is full");
  return SHB_OK;
}

/* After each point the curves may be published; a failure ends the tracing. */
static void a_failed_publication_ends_it(void **state) {
  (void)state;
  fixture f;
  int     segment, n = 0;
  mhb_end end;
  set_up(&f, 0);
  f.tracer->publish     = count;
  f.tracer->context     = &n;
  mhb_segment_plan plan = upwards(&f);
  assert_refused(mhb_tracer_trace(f.tracer, &plan, &segment, &end), SHB_ERR_IO, "disk is full");
  assert_int_equal(f.tracer->store->branch[segment].n_points, 5);
  tear_down(&f);
}

/* Points are the same to 1e-5 of the motion, or to what another number of harmonics changes. */
static void the_distance_that_counts_as_none(void **state) {
  (void)state;
  fixture f;
  set_up(&f, 0);
  assert_near(mhb_tracer_same(f.tracer), 1e-5, 1e-20);
  f.settings.motion_tolerance = 1e-3;
  assert_near(mhb_tracer_same(f.tracer), 2e-2, 1e-15);
  f.settings.motion_tolerance = 0;
  tear_down(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_segment_runs_from_end_to_end),
                                     cmocka_unit_test(peaks_are_local_maxima),
                                     cmocka_unit_test(round_off_is_no_part_of_higher_order),
                                     cmocka_unit_test(recorded_points_are_solutions),
                                     cmocka_unit_test(a_segment_may_be_traced_back),
                                     cmocka_unit_test(the_monitor_stops_it),
                                     cmocka_unit_test(points_of_a_branch_are_limited),
                                     cmocka_unit_test(without_a_solution_there_is_no_segment),
                                     cmocka_unit_test(a_segment_ends_at_its_target),
                                     cmocka_unit_test(a_failed_publication_ends_it),
                                     cmocka_unit_test(the_distance_that_counts_as_none)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
