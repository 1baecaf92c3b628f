#include "tests/support/peak_scan.h"

#include <complex.h>
#include <math.h>

#include "mhb/problem/parameter.h"
#include "mhb/tracking/tracked_response.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"

/* Peaks nearer than this are one, relative. */
static const double SAME = 1e-6;

/* A curve is looked at this far beside a peak, and is level below this slope, both relative. A
 * resonance has slopes of some 1 / (2 damping). */
static const double BESIDE = 1e-5, LEVEL = 1e-3;

/* A sweep locates a corner to this, relative. */
static const double CORNER = 2e-6;

/* Sweeps of these neighbourhoods, relative; the last is the whole range. */
enum { N_WINDOWS = 5 };
static const double WINDOW[N_WINDOWS] = {1e-3, 1e-5, 1e-4, 1e-2, 1};

mhb_response *peak_scan_follow(const peak_scan *scan) {
  mhb_response *r;
  shb_progress  quiet = shb_progress_start("mhb", true, false);
  assert_ok(mhb_tracked_response(scan->model, scan->settings, NULL, NULL, &quiet, &r));
  return r;
}

mhb_response *peak_scan_sweep(const peak_scan *scan, double value) {
  mhb_response      *r;
  const mhb_settings s = mhb_tracked_settings(scan->settings, value);
  assert_ok(main_curve(scan->model, &s, s.harmonics, NULL, &r));
  r->output_harmonic = s.output_harmonic;
  r->quantity        = s.output_quantity;
  return r;
}

/* Amplitude of the output that the run follows. */
static double amplitude_of(const peak_scan *scan, const mhb_response *r, const mhb_branch *b,
                           int point) {
  int output;
  assert_ok(mhb_output_named(scan->model, scan->settings->output, &output));
  return mhb_response_amplitude(r, b, point, output);
}

double peak_scan_highest(const peak_scan *scan, double value) {
  double        most = 0;
  mhb_response *r    = peak_scan_sweep(scan, value);
  for (int i = 0; i < r->branch[0].n_points; i++)
    most = fmax(most, amplitude_of(scan, r, &r->branch[0], i));
  mhb_response_destroy(r);
  return most;
}

/* By how much the highest amplitude rises from one side of a value to the other. */
static double rise(const peak_scan *scan, double value, double step) {
  return peak_scan_highest(scan, value + step) - peak_scan_highest(scan, value - step);
}

double peak_scan_lowest(const peak_scan *scan, int n, double distance) {
  const double low = scan->settings->range[0], high = scan->settings->range[1];
  double       least = INFINITY, at = low;
  for (int i = 0; i <= n; i++) {
    double value = low + (high - low) * i / n, a = peak_scan_highest(scan, value);
    if (a >= least) continue;
    least = a;
    at    = value;
  }
  const double step  = distance * at;
  double       from  = fmax(low + step, at - (high - low) / n);
  double       to    = fmin(high - step, at + (high - low) / n);
  double       left  = rise(scan, from, step);
  double       right = rise(scan, to, step);
  assert_true(left < 0 && right > 0);
  for (int i = 0; i < 30 && to - from > 1e-7 * at; i++) {
    double part   = left / (left - right);
    double middle = from + fmin(0.9, fmax(0.1, part)) * (to - from);
    double d      = rise(scan, middle, step);
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

/* Size of harmonic k of the first probe, m. */
static double harmonic_at(const mhb_branch *b, int point, int k) {
  const size_t K      = (size_t)b->n_harmonics + 1;
  double       square = 0;
  for (size_t axis = 0; axis < 3; axis++)
    square += pow(cabs(b->probe[((size_t)point * 3 + axis) * K + (size_t)k]), 2);
  return sqrt(square);
}

/* The maximum of a sweep that is nearest to *frequency; NAN: there is none. */
static double nearest_maximum(const peak_scan *scan, const mhb_response *r, double *frequency,
                              bool *first) {
  double            near = INFINITY, wanted = *frequency, amplitude = NAN;
  const mhb_branch *b = &r->branch[0];
  for (int i = 1; i + 1 < b->n_points; i++) {
    double here[3], of_first[3];
    for (int j = 0; j < 3; j++) {
      here[j]     = amplitude_of(scan, r, b, i - 1 + j);
      of_first[j] = harmonic_at(b, i - 1 + j, 1);
    }
    const double away = fabs(b->frequency[i] - wanted);
    if (here[1] < here[0] || here[1] < here[2] || away >= near) continue;
    near       = away;
    amplitude  = here[1];
    *frequency = b->frequency[i];
    *first     = of_first[1] > of_first[0] && of_first[1] > of_first[2];
  }
  return amplitude;
}

/* A sweep of the neighbourhood of a frequency, at most so far from it, relative. */
static mhb_response *sweep_beside(const peak_scan *scan, double value, double frequency,
                                  double away) {
  mhb_settings local = *scan->settings;
  local.frequency[0] = fmax(local.frequency[0], frequency * (1 - away));
  local.frequency[1] = fmin(local.frequency[1], frequency * (1 + away));
  return peak_scan_sweep(&(peak_scan){scan->model, &local}, value);
}

double peak_scan_near(const peak_scan *scan, double value, double *frequency, bool *first) {
  const double wanted    = *frequency;
  double       amplitude = NAN;
  for (size_t i = 0; i < N_WINDOWS; i++) {
    double        f    = wanted;
    mhb_response *r    = sweep_beside(scan, value, wanted, WINDOW[i]);
    const double  here = nearest_maximum(scan, r, &f, first);
    mhb_response_destroy(r);
    if (isnan(here) || (!isnan(amplitude) && fabs(f - wanted) >= fabs(*frequency - wanted)))
      continue;
    *frequency = f;
    amplitude  = here;
    if (fabs(f - wanted) < SAME * wanted) break;
  }
  return amplitude;
}

/* Whether the curve of a sweep passes through a point, and has its corner there, is level there or
 * nowhere higher beside it.
 *   corner  in  a sweep has a maximum at this frequency, to CORNER */
static bool curve_passes(const peak_scan *scan, const mhb_response *r, double frequency,
                         double amplitude, bool corner) {
  const mhb_branch *b  = &r->branch[0];
  bool              on = false, level = false, highest = true;
  for (int i = 0; i + 1 < b->n_points; i++) {
    double from = b->frequency[i] / frequency - 1, to = b->frequency[i + 1] / frequency - 1;
    if (fabs(from) > BESIDE) continue;
    highest = highest && amplitude_of(scan, r, b, i) < amplitude * (1 + SAME);
    if (mhb_response_is_linear(r, b, i) != mhb_response_is_linear(r, b, i + 1)) continue;
    if (fabs(to) > BESIDE || fabs(to - from) < 1e-9) continue;
    const double a     = amplitude_of(scan, r, b, i) / amplitude - 1;
    const double slope = (amplitude_of(scan, r, b, i + 1) / amplitude - 1 - a) / (to - from);
    const bool   here  = fabs(a - slope * from) < SAME;
    on                 = on || here;
    level              = level || (here && fabs(slope) < LEVEL);
  }
  return on && (corner || level || highest);
}

/* The same of sweeps of several neighbourhoods, which may begin on other motions. */
static bool passes(const peak_scan *scan, double value, double frequency, double amplitude,
                   bool corner) {
  bool found = false;
  for (size_t i = 0; i < N_WINDOWS && !found; i++) {
    mhb_response *r = sweep_beside(scan, value, frequency, WINDOW[i]);
    found           = curve_passes(scan, r, frequency, amplitude, corner);
    mhb_response_destroy(r);
  }
  return found;
}

/* One tracked peak. */
static void compare(const peak_scan *scan, const mhb_response *tracked, const mhb_branch *t, int i,
                    peak_agreement *out) {
  bool         first = false;
  const double value = t->value[i], amplitude = amplitude_of(scan, tracked, t, i);
  double       f = t->frequency[i], swept = peak_scan_near(scan, value, &f, &first);
  const double of_amplitude = isnan(swept) ? INFINITY : fabs(amplitude / swept - 1);
  const double of_frequency = fabs(t->frequency[i] / f - 1);
  out->n++;
  out->n_first += first;
  if (!(of_amplitude < SAME && of_frequency < SAME)) {
    const bool corner = of_frequency < CORNER && isfinite(swept);
    const bool there  = passes(scan, value, t->frequency[i], amplitude, corner);
    print_message("  point %d at %.9g, %.9g Hz: amplitude %.1e, frequency %.1e%s\n", i, value,
                  t->frequency[i], of_amplitude, of_frequency,
                  there ? "; on the curve of the sweep" : "");
    out->n_on_curve += there;
    if (there) return;
  }
  out->amplitude = fmax(out->amplitude, of_amplitude);
  out->frequency = fmax(out->frequency, of_frequency);
}

peak_agreement peak_scan_compare(const peak_scan *scan, const mhb_response *tracked) {
  peak_agreement out = {0};
  for (int b = 0; b < tracked->n_branches; b++) {
    const mhb_branch *t = &tracked->branch[b];
    print_message("%d points, %.6f to %.6f: %s\n", t->n_points, t->value[0],
                  t->value[t->n_points - 1], t->reason);
    for (int i = 1; i + 1 < t->n_points; i++) compare(scan, tracked, t, i, &out);
  }
  print_message("%d points, amplitude to %.1e, frequency to %.1e; %d of the first too\n", out.n,
                out.amplitude, out.frequency, out.n_first);
  return out;
}

void peak_scan_check_optimum(const peak_scan *scan, const mhb_response *tracked) {
  const mhb_optimum *o = &tracked->optimum;
  print_message("%s: %.9g (kind %d, error %.1e), amplitude %.9g\n",
                mhb_parameter_name(scan->settings->parameter), o->value, (int)o->kind, o->error,
                o->amplitude);
  double by_scan = peak_scan_lowest(scan, 8, o->kind == MHB_OPTIMUM_EXCHANGE ? 1e-6 : 1e-3);
  double least   = peak_scan_highest(scan, o->value);
  print_message("scan of sweeps: %.9g, relative %.1e; amplitude %.1e\n", by_scan,
                o->value / by_scan - 1, o->amplitude / least - 1);
  assert_true(o->verified);
  assert_small(o->value / by_scan - 1, 1e-5);
  assert_small(o->amplitude / least - 1, 1e-7);
}
