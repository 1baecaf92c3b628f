/* Whole runs of mhb.track on the model of three degrees of freedom. */
#include "mhb/tracking/tracked_response.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mhb/problem/parameter.h"
#include "tests/support/check.h"
#include "tests/support/peak_scan.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { H = 5 };

static modal_model model;

static int set_up(void **state) {
  (void)state;
  three_degree_model(&model);
  return 0;
}

static int tear_down(void **state) {
  (void)state;
  modal_model_free(&model);
  return 0;
}

static mhb_settings settings_of(mhb_track track, mhb_parameter parameter, double low, double high) {
  mhb_settings s = ground_settings(0.4, 0.8, 0.5, 0.25, H);
  s.frequency[0] = 0.9 / SHB_TWO_PI;
  s.frequency[1] = 1.8 / SHB_TWO_PI;
  s.tolerance    = 1e-10;
  s.stability    = MHB_STABILITY_NEVER;
  s.track        = track;
  s.parameter    = parameter;
  s.range[0]     = low;
  s.range[1]     = high;
  return s;
}

static void optimum_of_settings(const mhb_settings *s) {
  const peak_scan scan = {&model, s};
  mhb_response   *r    = peak_scan_follow(&scan);
  peak_scan_check_optimum(&scan, r);
  mhb_response_destroy(r);
}

static void optimum_of(mhb_parameter parameter, double low, double high) {
  const mhb_settings s = settings_of(MHB_TRACK_PEAKS, parameter, low, high);
  optimum_of_settings(&s);
}

static void the_optimum_of_the_preload_is_that_of_a_scan(void **state) {
  (void)state;
  optimum_of(MHB_IN_N0, 0.3, 0.6);
}

static void the_optimum_of_the_friction_coefficient_is_that_of_a_scan(void **state) {
  (void)state;
  optimum_of(MHB_IN_MU, 0.3, 1.2);
}

static void the_optimum_of_the_stiffness_is_that_of_a_scan(void **state) {
  (void)state;
  optimum_of(MHB_IN_KU, 0.1, 1.5);
}

/* Each tracked peak is that of a sweep.
 *   of_first  out  the share of those that are peaks of the first harmonic too */
static mhb_response *compare_with_sweeps(const mhb_settings *s, double *of_first) {
  const peak_scan scan   = {&model, s};
  mhb_response   *r      = peak_scan_follow(&scan);
  peak_agreement  agrees = peak_scan_compare(&scan, r);
  assert_true(agrees.n >= 10 && agrees.n_on_curve == 0);
  assert_below(agrees.amplitude, 1e-6);
  assert_below(agrees.frequency, 1e-6);
  assert_true(r->optimum.kind != MHB_OPTIMUM_NONE && r->optimum.verified);
  *of_first = (double)agrees.n_first / agrees.n;
  return r;
}

/* The third harmonic has peaks elsewhere than the first. */
static void peaks_of_the_third_harmonic_are_those_of_sweeps(void **state) {
  (void)state;
  enum { K = 3 };
  mhb_settings s = settings_of(MHB_TRACK_PEAKS, MHB_IN_N0, 0.1, 0.3);
  double       of_first;
  s.output_harmonic = K;
  mhb_response *r   = compare_with_sweeps(&s, &of_first);
  assert_int_equal(r->output_harmonic, K);
  assert_true(of_first < 0.5);
  mhb_response_destroy(r);
}

/* The peak to peak has its own peaks, at other frequencies than the first harmonic. */
static void peaks_of_the_peak_to_peak_are_those_of_sweeps(void **state) {
  (void)state;
  mhb_settings s = settings_of(MHB_TRACK_PEAKS, MHB_IN_N0, 0.1, 0.5);
  double       of_first;
  s.output_quantity = MHB_OUTPUT_PEAK_TO_PEAK;
  mhb_response *r   = compare_with_sweeps(&s, &of_first);
  assert_int_equal(r->quantity, MHB_OUTPUT_PEAK_TO_PEAK);
  assert_true(of_first < 0.5);
  mhb_response_destroy(r);
}

static void the_optimum_of_the_peak_to_peak_is_that_of_a_scan(void **state) {
  (void)state;
  mhb_settings s    = settings_of(MHB_TRACK_PEAKS, MHB_IN_N0, 0.3, 0.6);
  s.output_quantity = MHB_OUTPUT_PEAK_TO_PEAK;
  optimum_of_settings(&s);
}

/* Folds of a sweep near a frequency, Hz. */
static int folds_near(const mhb_settings *s, double value, double frequency) {
  mhb_response *r = peak_scan_sweep(&(peak_scan){&model, s}, value);
  int           n = 0;
  for (int i = 0; i < r->branch[0].n_points; i++)
    n += r->branch[0].special[i] == MHB_FOLD &&
         fabs(r->branch[0].frequency[i] / frequency - 1) < 2e-2;
  mhb_response_destroy(r);
  return n;
}

/* Two folds meet in a cusp: on one side of it a sweep has two more than on the other. */
static void folds_are_followed_to_their_cusps(void **state) {
  (void)state;
  mhb_settings  s    = settings_of(MHB_TRACK_FOLDS, MHB_IN_N0, 0.05, 0.6);
  mhb_response *r    = peak_scan_follow(&(peak_scan){&model, &s});
  int           seen = 0, right = 0;
  for (int b = 0; b < r->n_branches; b++) {
    const mhb_branch *k = &r->branch[b];
    print_message("%d points, %.6f to %.6f: %s\n", k->n_points, k->value[0],
                  k->value[k->n_points - 1], k->reason);
    for (int i = 1; i + 1 < k->n_points; i++) {
      if (k->special[i] != MHB_FOLD) continue;
      double beside = 3e-2 * k->value[i], f = k->frequency[i];
      int    below = folds_near(&s, k->value[i] - beside, f);
      int    above = folds_near(&s, k->value[i] + beside, f);
      print_message("cusp at n0 %.9f, %.9f Hz: folds %d below, %d above\n", k->value[i], f, below,
                    above);
      seen++;
      right += abs(below - above) == 2;
    }
  }
  assert_true(seen >= 2);
  assert_int_equal(right, seen);
  mhb_response_destroy(r);
}

/* No number of harmonics keeps the tolerance: every tracked peak is marked. */
static void peaks_above_the_tolerance_are_marked(void **state) {
  (void)state;
  mhb_settings s        = settings_of(MHB_TRACK_PEAKS, MHB_IN_N0, 0.1, 0.104);
  s.motion_tolerance    = 1e-9;
  s.harmonics           = 0; /* as many as it takes */
  const peak_scan scan  = {&model, &s};
  mhb_response   *r     = peak_scan_follow(&scan);
  const mhb_marks marks = mhb_response_marks(r);
  print_message("%d of %d tracked points marked, to %.1e\n", marks.marked, marks.points,
                marks.largest);
  assert_true(marks.marked > 2 && marks.marked == marks.points && marks.largest > 1e-9);
  mhb_response_destroy(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(peaks_above_the_tolerance_are_marked),
      cmocka_unit_test(the_optimum_of_the_preload_is_that_of_a_scan),
      cmocka_unit_test(the_optimum_of_the_friction_coefficient_is_that_of_a_scan),
      cmocka_unit_test(the_optimum_of_the_stiffness_is_that_of_a_scan),
      cmocka_unit_test(peaks_of_the_third_harmonic_are_those_of_sweeps),
      cmocka_unit_test(peaks_of_the_peak_to_peak_are_those_of_sweeps),
      cmocka_unit_test(the_optimum_of_the_peak_to_peak_is_that_of_a_scan),
      cmocka_unit_test(folds_are_followed_to_their_cusps)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
