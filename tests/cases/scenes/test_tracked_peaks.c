/* Tracked peaks and optima of two shipped scenes against sweeps of the frequency. */
#include <math.h>
#include <stdlib.h>

#include "cases/commands/load_model.h"
#include "cases/schema/case.h"
#include "mesh/base/constants.h"
#include "mhb/branches/record.h"
#include "mhb/tracking/kink.h"
#include "mhb/tracking/peak_derivatives.h"
#include "mhb/tracking/tracked_response.h"
#include "tests/support/peak_scan.h"
#include "tests/support/scene.h"

static char folder[SCRATCH_PATH];

static int set_up(void **state) {
  (void)state;
  scratch_create(folder);
  return 0;
}

static int tear_down(void **state) {
  (void)state;
  return scene_remove(folder);
}

/* Mesh and modes of a scene, and its settings with a fixed number of harmonics. */
static case_model scene_model(const char *name, int harmonics) {
  char       line[6 * SCRATCH_PATH], path[2 * SCRATCH_PATH];
  case_file  file;
  case_model model;
  snprintf(line, sizeof line, "'%s' modal --quiet --into '%s' '%s/%s/case.yaml'", SHROUDHB, folder,
           SCENE, name);
  if (system(line) != 0) fail_msg("failed: %s", line);
  snprintf(path, sizeof path, "%s/%s/case.yaml", SCENE, name);
  assert_ok(case_read(path, CASE_MHB, stderr, &file));
  snprintf(path, sizeof path, "%s/%s.modal.h5", folder, name);
  assert_ok(case_model_read(&file, path, 0, true, &model));
  case_free(&file);
  mhb_settings *s     = &model.settings;
  s->harmonics        = harmonics;
  s->motion_tolerance = 0;
  s->tolerance        = 1e-10;
  s->stability        = MHB_STABILITY_NEVER;
  s->lasting          = MHB_LASTING_NEVER;
  s->track            = MHB_TRACK_PEAKS;
  s->n_preloads       = 1;
  return model;
}

/* Every peak that is followed along the preload is the peak of a sweep there.
 *   least     in  number of peaks, at least
 *   on_curve  in  of these, peaks that a sweep resolves by its curve alone, at most */
static void peaks_are_those_of_sweeps(const char *name, int harmonics, double low, double high,
                                      int least, int on_curve) {
  case_model    model    = scene_model(name, harmonics);
  mhb_settings *s        = &model.settings;
  s->parameter           = MHB_IN_N0;
  s->range[0]            = low;
  s->range[1]            = high;
  s->n0[0]               = low;
  const peak_scan scan   = {&model.model, s};
  mhb_response   *r      = peak_scan_follow(&scan);
  peak_agreement  agrees = peak_scan_compare(&scan, r);
  assert_true(agrees.n >= least);
  assert_true(agrees.n_on_curve <= on_curve);
  assert_below(agrees.amplitude, 1e-6);
  assert_below(agrees.frequency, 1e-6);
  assert_true(r->optimum.verified);
  mhb_response_destroy(r);
  case_model_free(&model);
}

static void peaks_of_z_notch_blade_are_those_of_sweeps(void **state) {
  (void)state;
  peaks_are_those_of_sweeps("z_notch_blade", 7, 10, 500, 100, 4);
}

static void peaks_of_paper_fig9_are_those_of_sweeps(void **state) {
  (void)state;
  peaks_are_those_of_sweeps("paper_fig9", 3, 10, 1500, 100, 6);
}

/* From its middle both ways the branch is the same: it has the same ends. */
static void check_halves(mhb_balance *balance, const mhb_tracking *tracking, mhb_response *r,
                         const double *x, const mhb_peak_place *middle) {
  const mhb_tracking_seed seed  = {.x = x, .omega = middle->omega, .value = middle->value};
  const int               last  = r->branch[0].n_points - 1;
  mhb_response           *store = mhb_response_like(r);
  mhb_tracking_end        end;
  bool                    found;
  const int               index = mhb_response_branch(store, MHB_BRANCH_TRACKED);
  assert_ok(mhb_trace_kink(balance, tracking, &seed, store, index, &found, &end));
  const mhb_branch *b = &store->branch[index];
  assert_true(found);
  assert_int_equal(end.low, MHB_END_LOW);
  assert_int_equal(end.high, MHB_END_HIGH);
  for (int i = 0; i + 1 < b->n_points; i++) assert_true(b->value[i] < b->value[i + 1]);
  for (int i = 0; i < 2; i++) {
    const int own = i ? b->n_points - 1 : 0, other = i ? last : 0;
    assert_near(mhb_response_output(store, b, own) / mhb_response_output(r, &r->branch[0], other),
                1, 1e-9);
    assert_near(b->frequency[own] / r->branch[0].frequency[other], 1, 1e-9);
  }
  mhb_response_destroy(store);
}

/* dA/dq and domega/dq of the peak on a kink at a point of branch 0 are the limits of central
 * differences, of second order. */
static void check_at(const case_model *model, mhb_response *r, int point) {
  const mhb_branch  *branch   = &r->branch[0];
  const mhb_settings settings = mhb_tracked_settings(&model->settings, branch->value[point]);
  const mhb_tracking tracking = {
      .kind       = MHB_TRACK_PEAK,
      .max_points = 200,
      .parameter  = MHB_IN_KU,
      .low        = model->settings.range[0],
      .high       = model->settings.range[1],
      .frequency  = {SHB_TWO_PI * settings.frequency[0], SHB_TWO_PI * settings.frequency[1]}};
  mhb_peak_place at = {.value = branch->value[point],
                       .omega = SHB_TWO_PI * branch->frequency[point]};
  double         away[2][2];
  mhb_balance   *balance;
  mhb_kink      *kink;
  mhb_end        why;
  assert_ok(mhb_balance_create(&model->model, &settings, &balance));
  kink = mhb_kink_create(balance, &tracking);
  double x[balance->n], there[balance->n], by[MHB_PEAK_PARAMETERS];
  mhb_recorded_motion(branch, point, balance, x);
  assert_true(mhb_kink_start(kink, x, &at, &why));
  assert_true(mhb_kink_slip_share(kink) > 0);
  mhb_kink_maximum(kink, there, by);
  assert_below(fabs(by[MHB_PEAK_BY_KU] / at.slope - 1), 1e-9);
  mhb_peak_derivatives again;
  assert_ok(mhb_peak_derivatives_find(balance, 0, tracking.size, mhb_peak_at(at.omega), there,
                                      at.omega, at.amplitude, &again));
  assert_int_equal(again.kind, MHB_PEAK_KINK);
  assert_below(fabs(again.by[MHB_PEAK_BY_KU] / at.slope - 1), 1e-6);
  mhb_balance_go_to(balance, MHB_IN_KU, at.value);
  for (int i = 0; i < 2; i++) {
    const double   step    = (i ? 1e-3 : 2e-3) * at.value;
    mhb_peak_place side[2] = {mhb_peak_place_at(&at, at.value - step),
                              mhb_peak_place_at(&at, at.value + step)};
    for (int j = 0; j < 2; j++) assert_true(mhb_kink_start(kink, x, &side[j], &why));
    away[0][i] = (side[1].amplitude - side[0].amplitude) / (2 * step * at.slope) - 1;
    away[1][i] = (side[1].omega - side[0].omega) / (2 * step * at.rate) - 1;
  }
  for (int j = 0; j < 2; j++) {
    const double order = log2(fabs(away[j][0] / away[j][1]));
    print_message("%s: off by %.1e, %.1e, order %.2f\n", j ? "frequency" : "amplitude", away[j][0],
                  away[j][1], order);
    assert_true(order > 1.8 && order < 2.2);
  }
  mhb_kink_destroy(kink);
  check_halves(balance, &tracking, r, x, &at);
  mhb_balance_destroy(balance);
}

/* A phase of slip begins at the peak, over a hundredth of the stiffness. */
static void peaks_on_a_kink_are_those_of_sweeps(void **state) {
  (void)state;
  case_model    model    = scene_model("z_notch_blade", 7);
  mhb_settings *s        = &model.settings;
  s->parameter           = MHB_IN_KU;
  s->range[0]            = 2.283e6;
  s->range[1]            = 2.3e6;
  s->n0[0]               = 6.06;
  const peak_scan scan   = {&model.model, s};
  mhb_response   *r      = peak_scan_follow(&scan);
  peak_agreement  agrees = peak_scan_compare(&scan, r);
  assert_int_equal(r->n_branches, 1);
  assert_below(agrees.amplitude, 1e-7);
  assert_below(agrees.frequency, 1e-7);
  check_at(&model, r, r->branch[0].n_points / 2);
  mhb_response_destroy(r);
  case_model_free(&model);
}

/* The optimum of one parameter of z_notch_blade at a preload is that of a scan of sweeps. */
static void optimum_is_that_of_a_scan(mhb_parameter parameter, double n0, double low, double high) {
  case_model    model  = scene_model("z_notch_blade", 7);
  mhb_settings *s      = &model.settings;
  s->parameter         = parameter;
  s->range[0]          = low;
  s->range[1]          = high;
  s->n0[0]             = n0;
  s->tolerance         = 1e-6;
  const peak_scan scan = {&model.model, s};
  mhb_response   *r    = peak_scan_follow(&scan);
  peak_scan_check_optimum(&scan, r);
  mhb_response_destroy(r);
  case_model_free(&model);
}

static void the_optimum_of_the_preload_is_that_of_a_scan(void **state) {
  (void)state;
  optimum_is_that_of_a_scan(MHB_IN_N0, 10, 10, 20);
}

static void the_optimum_of_the_friction_coefficient_is_that_of_a_scan(void **state) {
  (void)state;
  optimum_is_that_of_a_scan(MHB_IN_MU, 12, 0.2, 0.5);
}

static void the_optimum_of_the_stiffness_is_that_of_a_scan(void **state) {
  (void)state;
  optimum_is_that_of_a_scan(MHB_IN_KU, 6, 1.5e6, 4e6);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(peaks_of_z_notch_blade_are_those_of_sweeps),
      cmocka_unit_test(peaks_of_paper_fig9_are_those_of_sweeps),
      cmocka_unit_test(peaks_on_a_kink_are_those_of_sweeps),
      cmocka_unit_test(the_optimum_of_the_preload_is_that_of_a_scan),
      cmocka_unit_test(the_optimum_of_the_friction_coefficient_is_that_of_a_scan),
      cmocka_unit_test(the_optimum_of_the_stiffness_is_that_of_a_scan)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
