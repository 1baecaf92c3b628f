#include "mhb/tracking/optimum.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/base/root.h"
#include "mhb/branches/record.h"
#include "mhb/numerics/vector.h"
#include "mhb/tracking/corner_point.h"
#include "mhb/tracking/kink.h"

/* Brackets of exchanges end at this length, relative to the parameter. */
static const double EXACT = 1e-9;

/* A corner or stuck peak sticks for this share of the period at least. Its frequency is near to the
 * one interpolated between points, relative. */
static const double NO_SLIP = 0.998, INTERPOLATED = 1e-3;

/* At a recorded corner h is this part of the friction limit at most. */
static const double AT_LIMIT = 1e-7;

typedef struct {
  const modal_model  *model;
  const mhb_settings *settings;
  const mhb_tracking *tracking;
  mhb_response       *response;
} search;

/* Amplitude of the tracked output at a recorded point. */
static double amplitude_of(const search *s, const mhb_branch *branch, int point) {
  return mhb_response_amplitude(s->response, branch, point, s->tracking->output);
}

/* The segment [i, i + 1] of a branch that holds a value, or -1. Branches of peaks ascend. */
static int segment_at(const mhb_branch *branch, double value) {
  for (int i = 0; i + 1 < branch->n_points; i++)
    if (branch->value[i] <= value && value <= branch->value[i + 1]) return i;
  return -1;
}

/* Amplitude of a branch at a value, linear between its points; -1 beyond its ends. */
static double interpolated(const search *s, int b, double value) {
  const mhb_branch *branch = &s->response->branch[b];
  int               i      = segment_at(branch, value);
  if (i < 0) return -1;
  double from = branch->value[i], to = branch->value[i + 1], a = amplitude_of(s, branch, i);
  return to > from ? a + (value - from) / (to - from) * (amplitude_of(s, branch, i + 1) - a) : a;
}

/* The branch that is highest at a value, or -1. */
static int highest_at(const search *s, double value, double *amplitude) {
  int best   = -1;
  *amplitude = 0;
  for (int b = 0; b < s->response->n_branches; b++) {
    double a = interpolated(s, b, value);
    if (a <= *amplitude) continue;
    *amplitude = a;
    best       = b;
  }
  return best;
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* All values of the parameter at points of the branches, ascending. */
static double *all_values(const mhb_response *r, int *n) {
  *n = 0;
  for (int b = 0; b < r->n_branches; b++) *n += r->branch[b].n_points;
  double *value = shb_alloc((size_t)*n, sizeof *value);
  int     at    = 0;
  for (int b = 0; b < r->n_branches; b++)
    for (int i = 0; i < r->branch[b].n_points; i++) value[at++] = r->branch[b].value[i];
  qsort(value, (size_t)*n, sizeof *value, ascending);
  return value;
}

/* ---- one peak, solved at a value ---- */

/* The pair whose corner recorded points i and i + 1 of a branch are; -1: all pairs stick there; -2:
 * neither. */
static int corner_of(const mhb_corner *corner, const mhb_branch *branch, int i, double *work) {
  const int pairs = corner->balance->n_pairs;
  int       first[pairs], second[pairs];
  bool      stuck = true;
  for (int j = 3 * i * pairs; j < 3 * (i + 2) * pairs; j += 3)
    stuck = stuck && branch->state[j + MHB_STICK] >= NO_SLIP;
  mhb_recorded_motion(branch, i, corner->balance, work);
  const int n = mhb_corner_candidates(corner, branch->value[i], work, AT_LIMIT, first);
  mhb_recorded_motion(branch, i + 1, corner->balance, work);
  const int m = mhb_corner_candidates(corner, branch->value[i + 1], work, AT_LIMIT, second);
  for (int j = 0; j < n; j++)
    for (int k = 0; k < m; k++)
      if (first[j] == second[k]) return first[j];
  return stuck ? -1 : -2;
}

/* A peak on a branch, between its points i and i + 1: guessed, then solved for. */
typedef struct {
  int    i;
  double value, amplitude, frequency; /* frequency in Hz */
} peak_place;

/* The same of a corner or stuck peak, from the motion x[n]. *found false: it is neither.
 *   work  out  [n] */
static shb_status corner_at(const search *s, mhb_balance *balance, const mhb_branch *branch,
                            const double *x, double *work, peak_place *at, bool *found) {
  mhb_corner *corner;
  double      omega = SHB_TWO_PI * at->frequency;
  corner            = mhb_corner_create(balance, s->tracking);
  const int pair    = corner_of(corner, branch, at->i, work);
  *found            = false;
  if (pair >= -1) {
    mhb_corner_take(corner, pair, at->value, x);
    *found = mhb_corner_solve(corner, at->value, pair < 0 ? -1 : 0, &omega) &&
             fabs(omega / (SHB_TWO_PI * at->frequency) - 1) <= INTERPOLATED;
  }
  if (*found) {
    at->amplitude = mhb_corner_evaluate(corner, omega, at->value).amplitude;
    at->frequency = omega / SHB_TWO_PI;
  }
  mhb_corner_destroy(corner);
  return SHB_OK;
}

/* The same of a smooth peak. at->amplitude stays where there is none. */
static shb_status smooth_at(const search *s, mhb_balance *balance, const double *x,
                            peak_place *at) {
  mhb_peak_system *system;
  mhb_curve_point  point;
  SHB_TRY(mhb_peak_system_create(
      balance, s->tracking->kind, s->tracking->output, s->tracking->parameter,
      s->tracking->frequency[1] - s->tracking->frequency[0], mhb_norm(x, balance->n), &system));
  mhb_curve_system *base = mhb_peak_system_base(system);
  mhb_peak_system_measure(base, s->tracking->size);
  mhb_curve_point_create(base, &point);
  mhb_peak_system_pack(base, x, SHB_TWO_PI * at->frequency, point.x);
  point.value = at->value;
  if (base->solve_at_value(base, 1e-10, &point) == MHB_CONVERGED) {
    at->amplitude = mhb_peak_system_report(base, &point).amplitude;
    at->frequency = mhb_peak_system_omega(base, point.x) / SHB_TWO_PI;
  }
  mhb_curve_point_destroy(base, &point);
  base->destroy(base);
  return SHB_OK;
}

/* The same of a peak on a kink. */
static shb_status kink_at(const search *s, mhb_balance *balance, const double *x, peak_place *at) {
  mhb_kink      *kink;
  const double   omega = SHB_TWO_PI * at->frequency;
  mhb_peak_place place = {.value = at->value, .omega = omega};
  mhb_end        unused;
  kink = mhb_kink_create(balance, s->tracking);
  if (mhb_kink_start(kink, x, &place, &unused) && fabs(place.omega / omega - 1) <= INTERPOLATED) {
    at->amplitude = place.amplitude;
    at->frequency = place.omega / SHB_TWO_PI;
  }
  mhb_kink_destroy(kink);
  return SHB_OK;
}

/* Amplitude and frequency (Hz) of the peak of a branch at a value inside it. NAN: not found. */
static shb_status peak_at(const search *s, int b, double value, double *amplitude,
                          double *frequency) {
  const mhb_branch *branch   = &s->response->branch[b];
  peak_place        at       = {segment_at(branch, value), value, NAN, 0};
  mhb_settings      settings = *s->settings;
  mhb_balance      *balance;
  settings.harmonics = branch->n_harmonics;
  SHB_TRY(mhb_balance_create(s->model, &settings, &balance));
  size_t        n = (size_t)balance->n;
  double       *x = shb_alloc_zeroed(2 * n, sizeof *x);
  const double *f = branch->frequency + at.i, from = branch->value[at.i];
  const double  to = branch->value[at.i + 1], part = to > from ? (value - from) / (to - from) : 0;
  mhb_recorded_motion(branch, at.i, balance, x);
  mhb_recorded_motion(branch, at.i + 1, balance, x + n);
  for (size_t j = 0; j < n; j++) x[j] += part * (x[n + j] - x[j]);
  at.frequency      = f[0] + part * (f[1] - f[0]);
  bool       corner = false;
  shb_status status = corner_at(s, balance, branch, x, x + n, &at, &corner);
  if (status == SHB_OK && !corner) status = smooth_at(s, balance, x, &at);
  if (status == SHB_OK && isnan(at.amplitude)) status = kink_at(s, balance, x, &at);
  *amplitude = at.amplitude;
  *frequency = at.frequency;
  free(x);
  mhb_balance_destroy(balance);
  return status;
}

/* Where branches b and c are equally high, between two values at which their order differs. */
static shb_status exchange(const search *s, int b, int c, const double value[2], mhb_optimum *out) {
  double   difference[2], a, f, other, g;
  shb_root root;
  for (int i = 0; i < 2; i++)
    difference[i] = interpolated(s, b, value[i]) - interpolated(s, c, value[i]);
  if (!shb_root_start(&root, value[0], difference[0], value[1], difference[1],
                      EXACT * fmax(fabs(value[0]), fabs(value[1]))))
    return SHB_OK;
  while (!shb_root_done(&root)) {
    double at = shb_root_next(&root);
    SHB_TRY(peak_at(s, b, at, &a, &f));
    SHB_TRY(peak_at(s, c, at, &other, &g));
    if (isfinite(a) && isfinite(other)) {
      shb_root_found(&root, at, a - other);
      *out = (mhb_optimum){MHB_OPTIMUM_EXCHANGE, at,   root.x[1] - root.x[0], {f, g},
                           fmax(a, other),       false};
    } else if (!shb_root_failed(&root)) {
      break;
    }
  }
  return SHB_OK;
}

bool mhb_is_highest(const mhb_tracking *tracking, mhb_response *response, int branch, int point,
                    double share) {
  search s = {.tracking = tracking, .response = response};
  double most;
  highest_at(&s, response->branch[branch].value[point], &most);
  return amplitude_of(&s, &response->branch[branch], point) >= share * most;
}

/* ---- the envelope ---- */

static void take_lower(mhb_optimum *best, const mhb_optimum *candidate) {
  if (candidate->kind == MHB_OPTIMUM_NONE) return;
  if (best->kind == MHB_OPTIMUM_NONE || candidate->amplitude < best->amplitude) *best = *candidate;
}

/* Recorded points that are highest at their value: extrema, and ends of branches. */
static void recorded_candidates(const search *s, mhb_optimum *best) {
  for (int b = 0; b < s->response->n_branches; b++) {
    const mhb_branch *branch = &s->response->branch[b];
    for (int i = 0; i < branch->n_points; i++) {
      bool end = i == 0 || i == branch->n_points - 1, extremum = branch->special[i] == MHB_OPTIMUM;
      double value = branch->value[i], a = amplitude_of(s, branch, i), most;
      if (!end && !extremum) continue;
      highest_at(s, value, &most);
      if (a < most * (1 - 1e-12)) continue;
      bool edge = value == s->tracking->low || value == s->tracking->high;
      /* the located extremum of a smooth peak: its error is that of event location */
      mhb_optimum candidate = {extremum ? MHB_OPTIMUM_SMOOTH
                               : edge   ? MHB_OPTIMUM_END
                                        : MHB_OPTIMUM_JUMP,
                               value,
                               extremum ? 1e-9 * fabs(value) : 0,
                               {branch->frequency[i], 0},
                               a,
                               false};
      take_lower(best, &candidate);
    }
  }
}

shb_status mhb_find_optimum(const modal_model *model, const mhb_settings *settings,
                            const mhb_tracking *tracking, mhb_response *response) {
  search      s    = {model, settings, tracking, response};
  mhb_optimum best = {0};
  int         n;
  response->optimum = best;
  if (tracking->kind != MHB_TRACK_PEAK) return SHB_OK;
  double *value = all_values(response, &n);
  recorded_candidates(&s, &best);
  shb_status status = SHB_OK;
  for (int i = 0; i + 1 < n && status == SHB_OK; i++) {
    double low, high, ends[2] = {value[i], value[i + 1]};
    int    b = highest_at(&s, ends[0], &low), c = highest_at(&s, ends[1], &high);
    if (b < 0 || c < 0 || b == c || fmin(low, high) >= best.amplitude * 1.05) continue;
    if (interpolated(&s, b, ends[1]) < 0 || interpolated(&s, c, ends[0]) < 0) continue;
    mhb_optimum candidate = {0};
    status                = exchange(&s, b, c, ends, &candidate);
    take_lower(&best, &candidate);
  }
  free(value);
  if (status == SHB_OK) response->optimum = best;
  return status;
}
