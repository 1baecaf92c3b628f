#include "mhb/tracking/tracked_response.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/clock.h"
#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/branches/forced_response.h"
#include "mhb/response/describe.h"
#include "mhb/response/publisher.h"
#include "mhb/tracking/corner.h"
#include "mhb/tracking/kink.h"
#include "mhb/tracking/optimum.h"
#include "mhb/tracking/sweep_peak.h"
#include "mhb/tracking/tracked_curve.h"

/* A seed lies on a curve if its frequency is within this of the curve's, relative. The curve is
 * interpolated between its points. */
static const double ON_CURVE = 5e-4;

/* Relative rounding of a value. */
static const double ROUNDED = 1e-12;

/* Peaks below this share of the highest of a sweep are not followed: they are not the highest near
 * by. Where they become the highest further on, another sweep has them. */
static const double MINOR = 0.85;

/* Sweeps at the ends of branches are this far beyond them, relative to the parameter. */
static const double BEYOND = 2e-3;

/* A peak that takes over at the end of a branch is this near to it in frequency, relative. */
static const double BESIDE_END = 2e-3;

/* Beyond ends of branches below this share of the highest peak there is no sweep. */
static const double NEARLY_HIGHEST = 0.9;

/* A peak is the highest of its sweep from this share of the largest amplitude on. */
static const double HIGHEST = 0.999;

/* Beyond the end of a branch another one is as high from this share of its amplitude on. */
static const double AS_HIGH = 0.97;

/* A peak of a sweep in outline may be higher than the optimum from this share of it on. */
static const double MAY_BE_HIGHER = 0.98;

/* A peak of an outline is that of a curve within reach whose amplitude it has to within this. */
static const double SAME_HEIGHT = 0.03;

/* Tolerance of the contact law in outlines. */
static const double OUTLINE = 1e-3;

enum { N_SWEEPS = 5, MOST_FURTHER_SWEEPS = 30, MOST_HARMONICS = 31, LEAST_HARMONICS = 7 };

/* The fewest harmonics where the program chooses: twice that of the output, and one more. */
static int least_harmonics(const mhb_settings *s) {
  int m = LEAST_HARMONICS;
  while (m < 2 * s->output_harmonic + 1) m = 2 * m + 1;
  return m;
}

typedef struct {
  const modal_model  *model;
  const mhb_settings *asked;
  mhb_settings        settings; /* of the tracked balance */
  mhb_tracking        tracking;
  mhb_response       *response;
  mhb_publisher       publisher;
  shb_progress       *progress;
  int                 n_lost;  /* highest peaks, or flips and the like, that led to no curve */
  double              lost_at; /* the first one's parameter */
} tracking_run;

/* ---- what is followed ---- */

shb_status mhb_output_named(const modal_model *model, const char *name, int *output) {
  *output = model->n_probes > 0 ? 0 : model->n_probes;
  if (!name[0]) return SHB_OK;
  *output = model->n_probes;
  if (strcmp(name, "contact") == 0) return SHB_OK;
  for (int i = 0; i < model->n_probes; i++) {
    if (strcmp(name, model->probe_name[i]) != 0) continue;
    *output = i;
    return SHB_OK;
  }
  char   known[400] = "contact";
  size_t n          = strlen(known);
  for (int i = 0; i < model->n_probes && n < sizeof known - 1; i++)
    n += (size_t)snprintf(known + n, sizeof known - n, ", %.40s", model->probe_name[i]);
  SHB_FAIL(SHB_ERR_INPUT, "mhb.output: the modal file has no probe '%s'; known: %s", name, known);
}

static const char *output_name(const tracking_run *run) {
  int place = run->tracking.output;
  return place < run->model->n_probes ? run->model->probe_name[place] : "contact";
}

static const mhb_size sizes[] = {[MHB_OUTPUT_HARMONIC]     = MHB_SIZE_HALF_AXIS,
                                 [MHB_OUTPUT_RSS]          = MHB_SIZE_RSS,
                                 [MHB_OUTPUT_PEAK_TO_PEAK] = MHB_SIZE_PEAK_TO_PEAK};

static mhb_tracking tracking_of(const mhb_settings *settings, int output) {
  static const mhb_tracked_point kind[MHB_N_TRACKS] = {
      [MHB_TRACK_NOTHING]         = MHB_TRACK_PEAK,
      [MHB_TRACK_PEAKS]           = MHB_TRACK_PEAK,
      [MHB_TRACK_FOLDS]           = MHB_TRACK_FOLD,
      [MHB_TRACK_FLIPS]           = MHB_TRACK_FLIP,
      [MHB_TRACK_NEIMARK_SACKERS] = MHB_TRACK_NEIMARK_SACKER};
  return (mhb_tracking){
      .kind       = kind[settings->track],
      .output     = output,
      .parameter  = settings->parameter,
      .low        = settings->range[0],
      .high       = settings->range[1],
      .frequency  = {SHB_TWO_PI * settings->frequency[0], SHB_TWO_PI * settings->frequency[1]},
      .max_points = settings->max_points,
      .size       = sizes[settings->output_quantity]};
}

/* Values of the parameter at which sweeps give seeds: geometric where the range allows it. */
static void seed_values(const mhb_tracking *tracking, double value[N_SWEEPS]) {
  double low = tracking->low, high = tracking->high;
  bool   ratio = low > 0 && high / low > 3;
  for (int i = 0; i < N_SWEEPS; i++) {
    double part = (double)i / (N_SWEEPS - 1);
    value[i]    = ratio ? low * pow(high / low, part) : low + part * (high - low);
  }
}

mhb_settings mhb_tracked_settings(const mhb_settings *settings, double value) {
  mhb_settings        s  = *settings;
  mhb_operating_point at = mhb_operating_point_of(&s);
  mhb_parameter_set(&at, s.parameter, value);
  s.scale      = at.scale;
  s.mu         = at.mu;
  s.kv         = at.kv;
  s.n_preloads = 1;
  s.n0[0]      = at.n0;
  memcpy(s.ku, at.ku, sizeof s.ku);
  s.parameter = MHB_IN_FREQUENCY;
  s.track     = MHB_TRACK_NOTHING;
  for (int i = 0; i < s.n_interfaces; i++) {
    const mhb_operating_point own = mhb_interface_operating_point(&at, settings, i);
    mhb_interface            *to  = &s.interface[i];
    to->n0[0]                     = own.n0;
    to->n_preloads                = 1;
    to->mu                        = own.mu;
    to->kv                        = own.kv;
    memcpy(to->ku, own.ku, sizeof to->ku);
  }
  return s;
}

/* A frequency sweep at a value of the parameter, curves only. Where the case leaves the number of
 * harmonics to the program, it has the fewest. A sweep that locates peaks has as many as needed.
 *   outline  in  its curves in outline */
static shb_status sweep_at(const tracking_run *run, double value, bool outline,
                           mhb_response **response) {
  mhb_settings s = mhb_tracked_settings(run->asked, value);
  if (!mhb_track_by_multiplier(mhb_track_word(run->asked->track)))
    s.stability = MHB_STABILITY_NEVER;
  s.lasting       = MHB_LASTING_NEVER;
  s.search.starts = 0;
  s.resume        = false;
  s.outline       = outline;
  if (outline) s.tolerance = fmax(s.tolerance, OUTLINE);
  if ((outline || run->tracking.kind != MHB_TRACK_PEAK) && s.motion_tolerance > 0) {
    s.harmonics        = least_harmonics(&s) * s.subharmonics;
    s.motion_tolerance = 0;
  }
  shb_progress quiet  = shb_progress_start("mhb", true, false);
  shb_status   status = mhb_forced_response(run->model, &s, NULL, NULL, &quiet, response);
  /* a curve with a gap still has peaks */
  return status == SHB_NOT_CONVERGED && *response ? SHB_OK : status;
}

/* ---- seeds ---- */

/* The peaks of a sweep that may be followed, and its highest amplitude. */
typedef struct {
  mhb_response   *sweep;
  bool            outline;
  double          value; /* of the parameter */
  double          most;
  int             n;
  mhb_sweep_peak *peak; /* [n] */
} sweep_peaks;

static void sweep_peaks_free(sweep_peaks *s) {
  mhb_response_destroy(s->sweep);
  free(s->peak);
  *s = (sweep_peaks){0};
}

/* The point to be followed at a point of the sweep. */
static bool is_seed(const tracking_run *run, const sweep_peaks *s, const mhb_branch *branch, int i,
                    mhb_sweep_peak *peak) {
  const int        output    = run->tracking.output;
  static const int special[] = {[MHB_TRACK_PEAK]           = MHB_PEAK,
                                [MHB_TRACK_FOLD]           = MHB_FOLD,
                                [MHB_TRACK_FLIP]           = MHB_FLIP,
                                [MHB_TRACK_NEIMARK_SACKER] = MHB_NEIMARK_SACKER};
  if (!s->outline && branch->special[i] != special[run->tracking.kind]) return false;
  if (run->tracking.kind == MHB_TRACK_PEAK)
    return i > 0 && i < branch->n_points - 1 &&
           mhb_sweep_peak_at(s->sweep, branch, i, output, s->outline, peak);
  *peak = (mhb_sweep_peak){.branch    = branch,
                           .point     = i,
                           .frequency = branch->frequency[i],
                           .amplitude = mhb_response_amplitude(s->sweep, branch, i, output),
                           .weight    = {0, 1, 0}};
  return true;
}

/* Find the peaks of the sweep. */
static void find_peaks(const tracking_run *run, sweep_peaks *s) {
  const mhb_response *r = s->sweep;
  int                 n = 0;
  for (int b = 0; b < r->n_branches; b++) n += r->branch[b].n_points;
  s->peak = shb_alloc((size_t)n, sizeof *s->peak);
  for (int b = 0; b < r->n_branches; b++) {
    const mhb_branch *branch = &r->branch[b];
    for (int i = 0; i < branch->n_points && branch->kind == MHB_BRANCH_NONLINEAR; i++) {
      s->most = fmax(s->most, mhb_response_amplitude(r, branch, i, run->tracking.output));
      if (is_seed(run, s, branch, i, &s->peak[s->n])) s->n++;
    }
  }
  for (int i = 0; i < s->n; i++) s->most = fmax(s->most, s->peak[i].amplitude);
}

/* Frequency between points i and i + 1 of a branch, by the cubic through them and those beside.
 * Linear, if the parameter does not run one way there. */
static double between(const mhb_branch *branch, int i, double value, bool cubic) {
  const int    from = cubic && i > 0 ? i - 1 : i, most = branch->n_points - 1;
  const int    to  = cubic && i + 2 <= most ? i + 2 : i + 1;
  const double way = branch->value[i + 1] - branch->value[i];
  double       sum = 0;
  for (int j = from; j < to; j++)
    if ((branch->value[j + 1] - branch->value[j]) * way <= 0)
      return between(branch, i, value, false);
  for (int j = from; j <= to; j++) {
    double weight = 1;
    for (int k = from; k <= to; k++)
      if (k != j) weight *= (value - branch->value[k]) / (branch->value[j] - branch->value[k]);
    sum += weight * branch->frequency[j];
  }
  return sum;
}

/* Frequency and amplitude of a tracked branch at a value of the parameter; NAN beyond its ends. At
 * a place that the curve passes twice, the ones nearest to a frequency. */
static double frequency_at(const tracking_run *run, const mhb_branch *branch, double value,
                           double near, double *amplitude) {
  double best = NAN;
  for (int i = 0; i + 1 < branch->n_points; i++) {
    double from = branch->value[i], to = branch->value[i + 1];
    double slack = ROUNDED * fmax(fabs(from), fabs(to)); /* an end of the range is rounded */
    if (from == to || value < fmin(from, to) - slack || value > fmax(from, to) + slack) continue;
    for (int cubic = 0; cubic < 2; cubic++) { /* the line is better at a kink */
      double f = between(branch, i, value, cubic);
      if (!isnan(best) && fabs(f - near) >= fabs(best - near)) continue;
      double a[2];
      for (int end = 0; end < 2; end++)
        a[end] = mhb_response_amplitude(run->response, branch, i + end, run->tracking.output);
      best       = f;
      *amplitude = a[0] + (value - from) / (to - from) * (a[1] - a[0]);
    }
  }
  return best;
}

/* Whether a tracked curve passes a peak of a sweep. */
static bool is_known(const tracking_run *run, double value, const mhb_sweep_peak *peak) {
  for (int b = 0; b < run->response->n_branches; b++) {
    double a = 0;
    double f = frequency_at(run, &run->response->branch[b], value, peak->frequency, &a);
    if (fabs(f - peak->frequency) <= ON_CURVE * peak->frequency) return true;
    if (fabs(f - peak->frequency) <= peak->reach * peak->frequency &&
        fabs(a / peak->amplitude - 1) <= SAME_HEIGHT)
      return true;
  }
  return false;
}

static void drop_last(mhb_response *response) {
  bool drop[response->n_branches];
  for (int b = 0; b < response->n_branches; b++) drop[b] = b == response->n_branches - 1;
  mhb_response_drop(response, drop);
}

/* Both ends of the range are ends of a tracked curve. */
static const char *end_text(mhb_end end) {
  return mhb_end_text(end == MHB_END_LOW ? MHB_END_HIGH : end);
}

/* Follow a point of a sweep with m harmonics, into a new branch.
 *   good  out  whether there is a curve, and its truncation error is within the tolerance */
static shb_status follow_with(tracking_run *run, const mhb_sweep_peak *peak, double value, int m,
                              bool *found, bool *good) {
  mhb_balance     *balance;
  mhb_tracking_end end;
  int              index;
  mhb_settings     settings = run->settings;
  mhb_tracking     tracking = run->tracking;
  bool             judge    = run->asked->harmonics == 0;
  *found                    = false;
  settings.harmonics        = m;
  tracking.tolerance        = judge && m < MOST_HARMONICS ? run->asked->motion_tolerance : 0;
  index                     = mhb_response_branch(run->response, MHB_BRANCH_TRACKED);
  run->response->branch[index].n_harmonics = m;
  SHB_TRY(mhb_balance_create(run->model, &settings, &balance));
  const int               n      = balance->n;
  double                 *x      = shb_alloc_zeroed(2 * (size_t)n, sizeof *x);
  shb_status              status = SHB_OK;
  const mhb_tracking_seed seed   = {.x         = x,
                                    .omega     = SHB_TWO_PI * peak->frequency,
                                    .value     = value,
                                    .reach     = peak->reach,
                                    .amplitude = peak->amplitude};
  mhb_sweep_peak_motion(peak, balance, x, x + n);
  if (peak->sticks)
    status = mhb_trace_corner(balance, &run->tracking, &seed, run->response, index, found, &end);
  if (status == SHB_OK && !*found)
    status = mhb_trace_tracked(balance, &tracking, &seed, run->response, index, found, &end);
  if (status == SHB_OK && !*found)
    status = mhb_trace_kink(balance, &run->tracking, &seed, run->response, index, found, &end);
  free(x);
  mhb_balance_destroy(balance);
  if (status != SHB_OK) return status;
  mhb_branch *branch = &run->response->branch[index];
  char        reason[200];
  snprintf(reason, sizeof reason, "%s; %s", end_text(end.low), end_text(end.high));
  branch->reason   = shb_text(reason);
  branch->searched = branch->complete = true;
  *good                               = *found;
  for (int i = 0; i < branch->n_points && judge; i++) {
    if (branch->error_truncation[i] <= run->asked->motion_tolerance) continue;
    branch->mark[i] |= MHB_ABOVE_TOLERANCE;
    *good = false;
  }
  return SHB_OK;
}

/* Follow a peak of a sweep with the fewest harmonics that suffice along all of its curve.
 * *lost: it cannot be followed. */
static shb_status follow(tracking_run *run, const mhb_sweep_peak *peak, double value, bool *lost) {
  int  fixed = run->asked->harmonics, m = fixed > 0 ? fixed : least_harmonics(run->asked);
  bool found = false, good = false;
  *lost = false;
  for (;; m = 2 * m + 1) {
    bool last = fixed > 0 || m >= MOST_HARMONICS;
    SHB_TRY(follow_with(run, peak, value, m, &found, &good));
    if (good || (last && found) || shb_interrupted()) return SHB_OK;
    drop_last(run->response);
    if (last) break;
  }
  *lost = true;
  return SHB_OK;
}

/* Follow the points of a sweep that are not known.
 *   lost  out  how many could not be followed; of peaks and folds those as high as the highest */
static shb_status follow_all(tracking_run *run, const sweep_peaks *s, int *lost) {
  *lost = 0;
  for (int i = 0; i < s->n && !shb_interrupted(); i++) {
    const mhb_sweep_peak *peak = &s->peak[i];
    bool                  gone;
    if (run->tracking.kind == MHB_TRACK_PEAK && peak->amplitude < MINOR * s->most) continue;
    if (is_known(run, s->value, peak)) continue;
    SHB_TRY(follow(run, peak, s->value, &gone));
    bool counts =
        mhb_track_by_multiplier(run->response->track) || peak->amplitude >= HIGHEST * s->most;
    *lost += gone && counts;
  }
  return SHB_OK;
}

/* ---- the work ---- */

static shb_status make_response(tracking_run *run, const mhb_response *sweep) {
  int fixed                      = run->asked->harmonics;
  run->settings.harmonics        = fixed > 0 ? fixed : MOST_HARMONICS;
  run->settings.motion_tolerance = 0;
  run->settings.stability        = MHB_STABILITY_NEVER;
  run->settings.n_preloads       = 1;
  run->response =
      mhb_response_create(run->model->n_pairs, run->model->n_probes, run->settings.harmonics);
  run->response->unfinished        = true;
  run->response->track             = shb_text(mhb_track_word(run->asked->track));
  run->response->output            = shb_text(output_name(run));
  run->response->tracks_multiplier = mhb_track_by_multiplier(run->response->track);
  run->response->psi               = sweep->psi;
  run->response->phi               = sweep->phi;
  return mhb_response_describe(run->response, run->model, &run->settings);
}

/* The peaks of a sweep at a value. Other points need a sweep that is more than an outline. */
static shb_status find_seeds(const tracking_run *run, double value, bool outline, sweep_peaks *s) {
  *s                = (sweep_peaks){.value = value, .outline = outline};
  shb_status status = sweep_at(run, value, outline, &s->sweep);
  if (status == SHB_OK) find_peaks(run, s);
  if (status != SHB_OK) sweep_peaks_free(s);
  return status;
}

/* Follow the points of a sweep that are not known yet. If the highest peak of an outline cannot be
 * followed, a sweep that locates it is made.
 *   lost  out  that did not help; how many are lost, as for follow_all */
static shb_status follow_seeds(tracking_run *run, const sweep_peaks *outline, int *lost) {
  SHB_TRY(follow_all(run, outline, lost));
  if (*lost == 0 || shb_interrupted()) return SHB_OK;
  if (outline->outline) {
    sweep_peaks located;
    SHB_TRY(find_seeds(run, outline->value, false, &located));
    shb_status status = follow_all(run, &located, lost);
    sweep_peaks_free(&located);
    if (status != SHB_OK) return status;
  }
  if (*lost > 0 && run->n_lost == 0) run->lost_at = outline->value;
  run->n_lost += run->response->tracks_multiplier ? *lost : *lost > 0;
  return SHB_OK;
}

/* A sweep at a value, and the curves through its peaks that are not known yet.
 *   higher  inout  an amplitude; out: the sweep has a peak above it that is on no curve, or that
 *                  could not be followed */
static shb_status sweep_and_follow(tracking_run *run, double value, double amplitude,
                                   bool *higher) {
  sweep_peaks seeds;
  shb_progress_show(run->progress, 90, "sweep at %s %.6g %s",
                    mhb_parameter_name(run->tracking.parameter), value,
                    mhb_parameter_unit(run->tracking.parameter));
  run->response->cost.sweeps++;
  double started = shb_processor_seconds();
  SHB_TRY(find_seeds(run, value, true, &seeds));
  run->response->cost.further += shb_processor_seconds() - started;
  int        lost;
  shb_status status = follow_seeds(run, &seeds, &lost);
  *higher           = lost > 0;
  for (int i = 0; i < seeds.n; i++)
    *higher = *higher || (seeds.peak[i].amplitude > amplitude * MAY_BE_HIGHER &&
                          !is_known(run, value, &seeds.peak[i]));
  sweep_peaks_free(&seeds);
  return status;
}

/* Whether another branch is as high beyond an end of a branch as that is there. */
static bool goes_on(const tracking_run *run, int b, int point, double value) {
  const mhb_response *r = run->response;
  double amplitude      = mhb_response_amplitude(r, &r->branch[b], point, run->tracking.output);
  for (int other = 0; other < r->n_branches; other++) {
    const mhb_branch *branch = &r->branch[other];
    for (int i = 0; other != b && i + 1 < branch->n_points; i++) {
      if (value < branch->value[i] || value > branch->value[i + 1]) continue;
      double low  = mhb_response_amplitude(r, branch, i, run->tracking.output);
      double high = mhb_response_amplitude(r, branch, i + 1, run->tracking.output);
      if (fmin(low, high) >= AS_HIGH * amplitude) return true;
    }
  }
  return false;
}

/* Follow the peak that a branch goes over into at an end. It is a corner where slip of a pair
 * begins or ends. Where a corner ends it is a smooth or stuck peak. */
static shb_status follow_from_end(tracking_run *run, int b, int point, double value) {
  mhb_response *store = mhb_response_like(run->response);
  bool          unused;
  store->n_harmonics = run->response->branch[b].n_harmonics;
  const int index    = mhb_response_branch(store, MHB_BRANCH_TRACKED);
  mhb_response_copy_points(store, index, run->response, b, point, point);
  const mhb_branch    *end  = &store->branch[index];
  const mhb_sweep_peak peak = {
      .branch    = end,
      .frequency = end->frequency[0],
      .amplitude = mhb_response_amplitude(store, end, 0, run->tracking.output),
      .reach     = BESIDE_END,
      .weight    = {0, 1, 0},
      .sticks    = true};
  const shb_status status = follow(run, &peak, value, &unused);
  mhb_response_destroy(store);
  return status;
}

/* Where a branch ends inside the range another peak takes over. The branch goes over into it, or a
 * known branch is as high there, or a sweep beyond the end finds it. */
static shb_status chain(tracking_run *run, int *budget) {
  for (int b = 0; b < run->response->n_branches; b++) {
    for (int end = 0; end < 2 && *budget > 0 && !shb_interrupted(); end++) {
      const mhb_branch *branch = &run->response->branch[b]; /* it moves when others are added */
      int               point  = end ? branch->n_points - 1 : 0;
      double            value  = branch->value[point];
      bool              unused;
      if (!mhb_is_highest(&run->tracking, run->response, b, point, NEARLY_HIGHEST)) continue;
      if (value <= run->tracking.low || value >= run->tracking.high) continue;
      value += (end ? BEYOND : -BEYOND) * fabs(value);
      if (value <= run->tracking.low || value >= run->tracking.high) continue;
      if (goes_on(run, b, point, value)) continue;
      SHB_TRY(follow_from_end(run, b, point, value));
      if (goes_on(run, b, point, value)) continue;
      --*budget;
      SHB_TRY(sweep_and_follow(run, value, INFINITY, &unused));
    }
  }
  return SHB_OK;
}

/* The optimum, until a sweep there finds no peak that is higher. */
static shb_status verified_optimum(tracking_run *run, int *budget) {
  mhb_optimum *optimum = &run->response->optimum;
  double       swept   = NAN;
  bool         higher  = false;
  while (!shb_interrupted()) {
    int before = run->response->n_branches;
    SHB_TRY(mhb_find_optimum(run->model, &run->settings, &run->tracking, run->response));
    if (optimum->kind == MHB_OPTIMUM_NONE) return SHB_OK;
    optimum->verified = optimum->value == swept && !higher; /* its new curves are below it */
    if (optimum->verified || (*budget)-- <= 0) return SHB_OK;
    SHB_TRY(sweep_and_follow(run, optimum->value, optimum->amplitude, &higher));
    swept             = optimum->value;
    optimum->verified = run->response->n_branches == before && !higher;
    if (run->response->n_branches == before) return SHB_OK;
    SHB_TRY(chain(run, budget));
  }
  return SHB_OK;
}

static shb_status run_all(tracking_run *run, sweep_peaks seeds[N_SWEEPS]) {
  const bool outline = run->tracking.kind == MHB_TRACK_PEAK;
  double     value[N_SWEEPS], started = shb_processor_seconds();
  seed_values(&run->tracking, value);
  shb_progress_show(run->progress, 0, "sweeps at %d values of %s", N_SWEEPS,
                    mhb_parameter_name(run->tracking.parameter));
#pragma omp parallel for schedule(dynamic, 1)
  for (int i = 0; i < N_SWEEPS; i++) {
    shb_status status = shb_interrupted() ? SHB_OK : find_seeds(run, value[i], outline, &seeds[i]);
    mhb_publisher_lock(&run->publisher, true);
    mhb_publisher_note(&run->publisher, status);
    mhb_publisher_lock(&run->publisher, false);
  }
  SHB_TRY(mhb_publisher_status(&run->publisher));
  if (shb_interrupted()) return SHB_OK;
  SHB_TRY(make_response(run, seeds[0].sweep));
  run->response->cost =
      (mhb_tracking_cost){.sweeps = N_SWEEPS, .seeds = shb_processor_seconds() - started};
  for (int i = 0; i < N_SWEEPS && !shb_interrupted(); i++) {
    shb_progress_show(run->progress, 20 + 80. * i / N_SWEEPS, "following from %s %.6g %s",
                      mhb_parameter_name(run->tracking.parameter), value[i],
                      mhb_parameter_unit(run->tracking.parameter));
    int unused;
    SHB_TRY(follow_seeds(run, &seeds[i], &unused));
  }
  int budget = MOST_FURTHER_SWEEPS;
  if (run->tracking.kind == MHB_TRACK_PEAK) {
    SHB_TRY(chain(run, &budget));
    SHB_TRY(verified_optimum(run, &budget));
  }
  run->response->unfinished = shb_interrupted();
  return mhb_publisher_write(&run->publisher, run->response);
}

shb_status mhb_tracked_response(const modal_model *model, const mhb_settings *settings,
                                const char *path, const shb_provenance *provenance,
                                shb_progress *progress, mhb_response **out) {
  int         output;
  sweep_peaks seeds[N_SWEEPS] = {{0}};
  *out                        = NULL;
  SHB_TRY(mhb_output_named(model, settings->output, &output));
  SHB_CHECK(
      !mhb_track_by_multiplier(mhb_track_word(settings->track)) || mhb_judges_stability(settings),
      SHB_ERR_INPUT,
      "mhb.track: %s needs multipliers; that takes a modal file with the modes of all nodal "
      "diameters (modal.nodal_diameters: all) and mhb.stability not never",
      mhb_track_word(settings->track));
  tracking_run run = {.model    = model,
                      .asked    = settings,
                      .settings = *settings,
                      .tracking = tracking_of(settings, output),
                      .progress = progress};
  mhb_publisher_start(&run.publisher, path, provenance);
  shb_status status = run_all(&run, seeds);
  mhb_publisher_stop(&run.publisher);
  for (int i = 0; i < N_SWEEPS; i++) sweep_peaks_free(&seeds[i]);
  if (status != SHB_OK) {
    mhb_response_destroy(run.response);
    return status;
  }
  *out = run.response;
  if (shb_interrupted())
    return shb_fail(SHB_INTERRUPTED, __FILE__, __LINE__,
                    "interrupted; the curves so far are saved");
  SHB_CHECK(run.n_lost == 0 || run.tracking.kind < MHB_TRACK_FLIP, SHB_NOT_CONVERGED,
            "%d %s point%s of sweeps could not be followed, the first at %s %g %s", run.n_lost,
            run.response->track, run.n_lost == 1 ? "" : "s",
            mhb_parameter_name(run.tracking.parameter), run.lost_at,
            mhb_parameter_unit(run.tracking.parameter));
  SHB_CHECK(run.n_lost == 0, SHB_NOT_CONVERGED,
            "the highest peak of %d sweep%s could not be followed, the first at %s %g %s",
            run.n_lost, run.n_lost == 1 ? "" : "s", mhb_parameter_name(run.tracking.parameter),
            run.lost_at, mhb_parameter_unit(run.tracking.parameter));
  return SHB_OK;
}
