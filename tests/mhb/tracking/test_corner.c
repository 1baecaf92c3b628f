/* Corner and stuck peaks followed along the preload against the peaks of frequency sweeps. */
#include "mhb/tracking/corner.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mhb/branches/record.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { H = 5, N = 3 * (2 * H + 1) };

static const mhb_tracking along_preload = {.kind       = MHB_TRACK_PEAK,
                                           .output     = 0,
                                           .parameter  = MHB_IN_N0,
                                           .low        = 0.1,
                                           .high       = 1.5,
                                           .frequency  = {1.1, 1.32},
                                           .max_points = 2000};

typedef struct {
  modal_model   model;
  mhb_settings  settings;
  mhb_balance  *balance;
  mhb_response *response;
  int           branch;
} fixture;

static void set_up(fixture *f) {
  *f                       = (fixture){0};
  f->settings              = ground_settings(0.4, 0.8, 0.5, 0.45, H);
  f->settings.frequency[0] = along_preload.frequency[0] / SHB_TWO_PI;
  f->settings.frequency[1] = along_preload.frequency[1] / SHB_TWO_PI;
  f->settings.tolerance    = 1e-10;
  three_degree_model(&f->model);
  assert_ok(mhb_balance_create(&f->model, &f->settings, &f->balance));
  f->response            = mhb_response_create(1, f->model.n_probes, H);
  f->response->parameter = MHB_IN_N0;
  f->branch              = mhb_response_branch(f->response, MHB_BRANCH_TRACKED);
}

static void tear_down(fixture *f) {
  mhb_response_destroy(f->response);
  mhb_balance_destroy(f->balance);
  modal_model_free(&f->model);
}

/* The highest point of a sweep at a preload: frequency Hz, amplitude, motion x[N] or NULL. */
static double highest_point(const fixture *f, double n0, double *frequency, double *x) {
  mhb_response *r;
  double        most     = 0;
  mhb_settings  settings = f->settings;
  settings.n0[0]         = n0;
  assert_ok(main_curve(&f->model, &settings, H, NULL, &r));
  for (int i = 0; i < r->branch[0].n_points; i++) {
    double a = mhb_response_output(r, &r->branch[0], i);
    if (a <= most) continue;
    most       = a;
    *frequency = r->branch[0].frequency[i];
    if (x) mhb_recorded_motion(&r->branch[0], i, f->balance, x);
  }
  mhb_response_destroy(r);
  return most;
}

static void follow(fixture *f, double n0, mhb_tracking_end *end) {
  double            x[N], frequency = 0;
  bool              found;
  mhb_tracking_seed seed = {.x = x, .value = n0};
  highest_point(f, n0, &frequency, x);
  seed.omega = SHB_TWO_PI * frequency;
  assert_ok(
      mhb_trace_corner(f->balance, &along_preload, &seed, f->response, f->branch, &found, end));
  assert_true(found);
}

/* Frequency and amplitude of the marked peak of a sweep that is nearest to *frequency. */
static double peak_near(const fixture *f, double n0, double *frequency) {
  mhb_response *r;
  double        near = INFINITY, wanted = *frequency, amplitude = 0;
  mhb_settings  settings = f->settings;
  settings.n0[0]         = n0;
  assert_ok(main_curve(&f->model, &settings, H, NULL, &r));
  for (int i = 0; i < r->branch[0].n_points; i++) {
    double away = fabs(r->branch[0].frequency[i] - wanted);
    if (r->branch[0].special[i] != MHB_PEAK || away >= near) continue;
    near       = away;
    *frequency = r->branch[0].frequency[i];
    amplitude  = mhb_response_output(r, &r->branch[0], i);
  }
  mhb_response_destroy(r);
  return amplitude;
}

/* Follow from n0 and compare every fifth point with the peak of a sweep. */
static void compare(fixture *f, double n0, mhb_tracking_end *end) {
  double worst = 0, worst_f = 0;
  follow(f, n0, end);
  const mhb_branch *t = &f->response->branch[f->branch];
  print_message("%d points, n0 %.9g to %.9g (%s; %s)\n", t->n_points, t->value[0],
                t->value[t->n_points - 1], mhb_end_text(end->low), mhb_end_text(end->high));
  for (int i = 0; i < t->n_points; i++) {
    assert_below(t->error_newton[i], 1e-5);
    if (i > 0) assert_true(t->value[i] > t->value[i - 1]);
    if (i % 5) continue;
    double fs = t->frequency[i], as = peak_near(f, t->n0[i], &fs);
    worst   = fmax(worst, fabs(mhb_response_output(f->response, t, i) / as - 1));
    worst_f = fmax(worst_f, fabs(t->frequency[i] / fs - 1));
  }
  print_message("amplitude to %.1e, frequency to %.1e\n", worst, worst_f);
  assert_below(worst, 1e-6);
  assert_below(worst_f, 1e-6);
}

/* The corner is the maximum over a factor of 1.65 in the preload. Above it the stuck peak is. */
static void each_corner_is_the_peak_of_a_sweep(void **state) {
  (void)state;
  fixture          f;
  mhb_tracking_end end;
  set_up(&f);
  compare(&f, 0.45, &end);
  const mhb_branch *t = &f.response->branch[f.branch];
  assert_int_equal(end.low, MHB_END_TURNED);
  assert_int_equal(end.high, MHB_END_CORNER);
  assert_true(t->value[0] < 0.4 && t->value[t->n_points - 1] > 0.55);
  tear_down(&f);
}

static void a_stuck_peak_goes_on_where_the_corner_ends(void **state) {
  (void)state;
  fixture          corner, stuck;
  mhb_tracking_end end;
  set_up(&corner);
  follow(&corner, 0.45, &end);
  set_up(&stuck);
  compare(&stuck, 0.8, &end);
  const mhb_branch *c     = &corner.response->branch[corner.branch];
  const mhb_branch *s     = &stuck.response->branch[stuck.branch];
  int               last  = c->n_points - 1;
  double            above = mhb_response_output(stuck.response, s, 0);
  assert_int_equal(end.high, MHB_END_HIGH);
  assert_small(s->value[0] - c->value[last], 1e-6);
  assert_small(mhb_response_output(corner.response, c, last) / above - 1, 1e-8);
  tear_down(&corner);
  tear_down(&stuck);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_corner_is_the_peak_of_a_sweep),
                                     cmocka_unit_test(a_stuck_peak_goes_on_where_the_corner_ends)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
