/* Whole runs of mhb.track on the model of three degrees of freedom. */
#include "mhb/tracking/tracked_response.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mhb/problem/parameter.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
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

static mhb_response *follow(const mhb_settings *s) {
  mhb_response *r;
  shb_progress  quiet = shb_progress_start("mhb", true, false);
  assert_ok(mhb_tracked_response(&model, s, NULL, NULL, &quiet, &r));
  return r;
}

static mhb_response *sweep_at(const mhb_settings *tracked, double value) {
  mhb_response       *r;
  mhb_settings        s  = *tracked;
  mhb_operating_point at = mhb_operating_point_of(&s);
  mhb_parameter_set(&at, s.parameter, value);
  s.n0[0]     = at.n0;
  s.mu        = at.mu;
  s.ku[0]     = at.ku[0];
  s.ku[1]     = at.ku[1];
  s.ku[2]     = at.ku[2];
  s.parameter = MHB_IN_FREQUENCY;
  s.track     = MHB_TRACK_NOTHING;
  assert_ok(main_curve(&model, &s, H, NULL, &r));
  r->output_harmonic = s.output_harmonic;
  r->peak_to_peak    = s.output_quantity == MHB_OUTPUT_PEAK_TO_PEAK;
  return r;
}

/* The highest amplitude of a sweep. */
static double highest(const mhb_settings *s, double value) {
  double        most = 0;
  mhb_response *r    = sweep_at(s, value);
  for (int i = 0; i < r->branch[0].n_points; i++)
    most = fmax(most, mhb_response_output(r, &r->branch[0], i));
  mhb_response_destroy(r);
  return most;
}

/* Where the highest peak of sweeps is least. The lowest of a scan comes first, then the root of the
 * difference between two sweeps beside it, at a relative distance. 1e-3 leaves an error of some
 * 1e-6 where the peak is smooth. At a kink the error is of the order of the distance. */
static double scan(const mhb_settings *s, double low, double high, int n, double distance) {
  double least = INFINITY, at = low;
  for (int i = 0; i <= n; i++) {
    double value = low + (high - low) * i / n, a = highest(s, value);
    if (a >= least) continue;
    least = a;
    at    = value;
  }
  const double step  = distance * at;
  double       from  = fmax(low + step, at - (high - low) / n);
  double       to    = fmin(high - step, at + (high - low) / n);
  double       left  = highest(s, from + step) - highest(s, from - step);
  double       right = highest(s, to + step) - highest(s, to - step);
  assert_true(left < 0 && right > 0);
  for (int i = 0; i < 30 && to - from > 1e-7 * at; i++) {
    double part   = left / (left - right);
    double middle = from + fmin(0.9, fmax(0.1, part)) * (to - from);
    double d      = highest(s, middle + step) - highest(s, middle - step);
    if (d < 0) {
      from = middle;
      left = d;
    } else {
      to    = middle;
      right = d;
    }
    if (fabs(d) < 1e-10 * least) return middle;
  }
  return 0.5 * (from + to);
}

static void optimum_of_settings(const mhb_settings *s) {
  mhb_response      *r = follow(s);
  const mhb_optimum *o = &r->optimum;
  print_message("%s: %.9f (kind %d, error %.1e), amplitude %.9f\n",
                mhb_parameter_name(s->parameter), o->value, (int)o->kind, o->error, o->amplitude);
  double by_scan =
      scan(s, s->range[0], s->range[1], 8, o->kind == MHB_OPTIMUM_EXCHANGE ? 1e-6 : 1e-3);
  double least = highest(s, o->value);
  print_message("scan of sweeps: %.9f, relative %.1e; amplitude %.1e\n", by_scan,
                o->value / by_scan - 1, o->amplitude / least - 1);
  assert_true(o->verified);
  assert_small(o->value / by_scan - 1, 1e-5);
  assert_small(o->amplitude / least - 1, 1e-7);
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

/* Size of harmonic k of the first probe, m. */
static double harmonic_at(const mhb_branch *b, int point, int k) {
  const size_t K      = (size_t)b->n_harmonics + 1;
  double       square = 0;
  for (size_t axis = 0; axis < 3; axis++)
    square += pow(cabs(b->probe[((size_t)point * 3 + axis) * K + (size_t)k]), 2);
  return sqrt(square);
}

/* Amplitude of the tracked output at a maximum of a sweep: a point no lower than those beside it.
 * Of several, the nearest to a frequency. The sweep is of that neighbourhood.
 *   frequency  inout  Hz
 *   first      out    whether the first harmonic has one there too */
static double maximum_near(const mhb_settings *s, double value, double *frequency, bool *first) {
  double       near = INFINITY, wanted = *frequency, amplitude = NAN;
  mhb_settings local  = *s;
  local.frequency[0]  = wanted * (1 - 1e-3);
  local.frequency[1]  = wanted * (1 + 1e-3);
  mhb_response     *r = sweep_at(&local, value);
  const mhb_branch *b = &r->branch[0];
  for (int i = 1; i + 1 < b->n_points; i++) {
    double here[3], of_first[3];
    for (int j = 0; j < 3; j++) {
      here[j]     = mhb_response_output(r, b, i - 1 + j);
      of_first[j] = harmonic_at(b, i - 1 + j, 1);
    }
    const double away = fabs(b->frequency[i] - wanted);
    if (here[1] < here[0] || here[1] < here[2] || away >= near) continue;
    near       = away;
    amplitude  = here[1];
    *frequency = b->frequency[i];
    *first     = of_first[1] > of_first[0] && of_first[1] > of_first[2];
  }
  mhb_response_destroy(r);
  return amplitude;
}

/* Each tracked peak is that of a sweep.
 *   of_first  out  the share of those that are peaks of the first harmonic too */
static mhb_response *compare_with_sweeps(const mhb_settings *s, double *of_first) {
  double        worst = 0, worst_f = 0;
  int           points = 0, shared = 0;
  mhb_response *r = follow(s);
  for (int b = 0; b < r->n_branches; b++) {
    const mhb_branch *t = &r->branch[b];
    print_message("%d points, %.6f to %.6f: %s\n", t->n_points, t->value[0],
                  t->value[t->n_points - 1], t->reason);
    for (int i = 1; i + 1 < t->n_points; i++) {
      bool   first = false;
      double f = t->frequency[i], swept = maximum_near(s, t->value[i], &f, &first);
      worst   = fmax(worst, fabs(mhb_response_output(r, t, i) / swept - 1));
      worst_f = fmax(worst_f, fabs(t->frequency[i] / f - 1));
      shared += first;
      points++;
    }
  }
  print_message("%d points, amplitude to %.1e, frequency to %.1e; %d of the first too\n", points,
                worst, worst_f, shared);
  assert_true(points >= 10);
  assert_below(worst, 1e-6);
  assert_below(worst_f, 1e-6);
  assert_true(r->optimum.kind != MHB_OPTIMUM_NONE && r->optimum.verified);
  *of_first = (double)shared / points;
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
  assert_true(r->peak_to_peak);
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
  mhb_response *r = sweep_at(s, value);
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
  mhb_response *r    = follow(&s);
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

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_optimum_of_the_preload_is_that_of_a_scan),
      cmocka_unit_test(the_optimum_of_the_friction_coefficient_is_that_of_a_scan),
      cmocka_unit_test(the_optimum_of_the_stiffness_is_that_of_a_scan),
      cmocka_unit_test(peaks_of_the_third_harmonic_are_those_of_sweeps),
      cmocka_unit_test(peaks_of_the_peak_to_peak_are_those_of_sweeps),
      cmocka_unit_test(the_optimum_of_the_peak_to_peak_is_that_of_a_scan),
      cmocka_unit_test(folds_are_followed_to_their_cusps)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
