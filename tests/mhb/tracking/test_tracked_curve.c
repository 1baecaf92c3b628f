/* Peaks followed along a parameter against the peaks of frequency sweeps. */
#include "mhb/tracking/tracked_curve.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mhb/branches/record.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { H = 5, N = 3 * (2 * H + 1) };

/* A maximum ends this near, relative, where a corner is as high. */
static const double BESIDE = 1e-4;

/* Amplitude and frequency of the peak of a sweep at a preload that lies nearest to *f.
 *   f  inout  Hz
 *   x  out    [N] its motion, or NULL */
static double sweep_peak(const modal_model *model, mhb_settings settings, double n0, double *f,
                         const mhb_balance *b, double *x) {
  mhb_response *r;
  double        near = INFINITY, wanted = *f, amplitude = 0;
  settings.n0[0] = n0;
  assert_ok(main_curve(model, &settings, H, NULL, &r));
  const mhb_branch *branch = &r->branch[0];
  for (int i = 0; i < branch->n_points; i++) {
    double away = fabs(branch->frequency[i] - wanted);
    if (branch->special[i] != MHB_PEAK || away >= near) continue;
    near      = away;
    *f        = branch->frequency[i];
    amplitude = mhb_response_output(r, branch, i);
    if (x) mhb_recorded_motion(branch, i, b, x);
  }
  mhb_response_destroy(r);
  return amplitude;
}

static void each_tracked_peak_is_that_of_a_sweep(void **state) {
  (void)state;
  modal_model   model;
  mhb_settings  settings = ground_settings(0.4, 0.8, 0.5, 0.2, H);
  mhb_balance  *b;
  mhb_response *r;
  int           branch;
  bool          found;
  double        x[N], f = 0.22;
  three_degree_model(&model);
  settings.frequency[0] = 0.9 / SHB_TWO_PI;
  settings.frequency[1] = 1.8 / SHB_TWO_PI;
  settings.tolerance    = 1e-10;
  assert_ok(mhb_balance_create(&model, &settings, &b));
  double a0 = sweep_peak(&model, settings, 0.2, &f, b, x);
  assert_true(a0 > 0);
  mhb_balance_set_preload(b, 0.2);
  mhb_tracking      tracking = {.kind       = MHB_TRACK_PEAK,
                                .output     = 0,
                                .parameter  = MHB_IN_N0,
                                .low        = 0.02,
                                .high       = 1.5,
                                .frequency  = {0.5, 2},
                                .max_points = 2000};
  mhb_tracking_seed seed     = {.x = x, .omega = SHB_TWO_PI * f, .value = 0.2};
  mhb_tracking_end  end;
  r            = mhb_response_create(1, model.n_probes, H);
  r->parameter = MHB_IN_N0;
  branch       = mhb_response_branch(r, MHB_BRANCH_TRACKED);
  assert_ok(mhb_trace_tracked(b, &tracking, &seed, r, branch, &found, &end));
  const mhb_branch *t          = &r->branch[branch];
  int               iterations = 0;
  for (int i = 0; i < t->n_points; i++) iterations += t->iterations[i];
  print_message("%d points, n0 %g to %g (%s; %s), %d iterations\n", t->n_points, t->value[0],
                t->value[t->n_points - 1], mhb_end_text(end.low), mhb_end_text(end.high),
                iterations);
  assert_true(found);
  double worst = 0, worst_f = 0, highest = 0;
  for (int i = 0; i < t->n_points; i++) highest = fmax(highest, t->n0[i]);
  for (int i = 0; i < t->n_points; i++) {
    if (i % 6 && t->special[i] != MHB_OPTIMUM) continue;
    if (t->n0[i] > (1 - BESIDE) * highest) continue; /* the corner beside it is as high there */
    double fs = t->frequency[i], as = sweep_peak(&model, settings, t->n0[i], &fs, b, NULL);
    double at = mhb_response_output(r, t, i);
    print_message("n0 %9.6f  f %.9f sweep %.9f  a %.9f sweep %.9f special %d\n", t->n0[i],
                  t->frequency[i], fs, at, as, t->special[i]);
    worst   = fmax(worst, fabs(at / as - 1));
    worst_f = fmax(worst_f, fabs(t->frequency[i] / fs - 1));
  }
  print_message("amplitude to %.1e, frequency to %.1e\n", worst, worst_f);
  assert_below(worst, 1e-6);
  assert_below(worst_f, 1e-6);
  mhb_response_destroy(r);
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_tracked_peak_is_that_of_a_sweep)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
