#include "mhb/tracking/tracked_response.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/record.h"
#include "mhb/response/describe.h"
#include "mhb/response/publisher.h"
#include "mhb/tracking/corner.h"
#include "mhb/tracking/optimum.h"
#include "mhb/tracking/tracked_curve.h"

/* A seed lies on a curve if its frequency is within this of the curve's, relative. The curve is
 * interpolated between its points. */
static const double ON_CURVE = 5e-4;

/* Relative rounding of a value. */
static const double ROUNDED = 1e-12;

/* Peaks below this share of the highest at the same value of the parameter are not followed. */
static const double MINOR = 0.4;

/* Sweeps at the ends of branches are this far beyond them, relative to the parameter. */
static const double BEYOND = 2e-3;

/* Beyond ends of branches below this share of the highest peak there is no sweep. */
static const double NEARLY_HIGHEST = 0.9;

/* A peak is the highest of its sweep from this share of the largest amplitude on. */
static const double HIGHEST = 0.999;

/* Beyond the end of a branch another one is as high from this share of its amplitude on. */
static const double AS_HIGH = 0.97;

/* A peak of a sweep is higher than the optimum if it exceeds it by this, relative. */
static const double HIGHER = 1e-4;

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
  int                 n_lost;  /* highest peaks of sweeps that led to no curve */
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
      .max_points = settings->max_points};
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

/* The settings at a value of the parameter. */
static mhb_settings settings_at(const mhb_settings *settings, mhb_parameter parameter,
                                double value) {
  mhb_settings        s  = *settings;
  mhb_operating_point at = mhb_operating_point_of(&s);
  mhb_parameter_set(&at, parameter, value);
  s.scale      = at.scale;
  s.mu         = at.mu;
  s.kv         = at.kv;
  s.n_preloads = 1;
  s.n0[0]      = at.n0;
  memcpy(s.ku, at.ku, sizeof s.ku);
  return s;
}

/* A frequency sweep at a value of the parameter, curves only.
 *   coarse  in  with the fewest harmonics, where the case leaves their number to the program */
static shb_status sweep_at(const tracking_run *run, double value, bool coarse,
                           mhb_response **response) {
  mhb_settings s = settings_at(run->asked, run->tracking.parameter, value);
  s.parameter    = MHB_IN_FREQUENCY;
  s.track        = MHB_TRACK_NOTHING;
  if (!mhb_track_by_multiplier(mhb_track_word(run->asked->track)))
    s.stability = MHB_STABILITY_NEVER;
  s.lasting       = MHB_LASTING_NEVER;
  s.search.starts = 0;
  s.resume        = false;
  if (coarse && s.motion_tolerance > 0) {
    s.harmonics        = least_harmonics(&s) * s.subharmonics;
    s.motion_tolerance = 0;
  }
  shb_progress quiet  = shb_progress_start("mhb", true, false);
  shb_status   status = mhb_forced_response(run->model, &s, NULL, NULL, &quiet, response);
  /* a curve with a gap still has peaks */
  return status == SHB_NOT_CONVERGED && *response ? SHB_OK : status;
}

/* ---- seeds ---- */

/* The highest amplitude of the output in a sweep. */
static double highest(const tracking_run *run, const mhb_response *r) {
  double most = 0;
  for (int b = 0; b < r->n_branches; b++)
    for (int i = 0; i < r->branch[b].n_points && r->branch[b].kind == MHB_BRANCH_NONLINEAR; i++)
      most = fmax(most, mhb_response_amplitude(r, &r->branch[b], i, run->tracking.output));
  return most;
}

/* Whether a point is to be followed; most: the highest amplitude of its sweep. */
static bool is_seed(const tracking_run *run, const mhb_response *r, const mhb_branch *branch, int i,
                    double most) {
  const int        output    = run->tracking.output;
  static const int special[] = {[MHB_TRACK_PEAK]           = MHB_PEAK,
                                [MHB_TRACK_FOLD]           = MHB_FOLD,
                                [MHB_TRACK_FLIP]           = MHB_FLIP,
                                [MHB_TRACK_NEIMARK_SACKER] = MHB_NEIMARK_SACKER};
  if (run->tracking.kind != MHB_TRACK_PEAK)
    return branch->special[i] == special[run->tracking.kind];
  if (branch->special[i] != MHB_PEAK || i == 0 || i == branch->n_points - 1) return false;
  double a = mhb_response_amplitude(r, branch, i, output);
  return a >= MINOR * most && a >= mhb_response_amplitude(r, branch, i - 1, output) &&
         a >= mhb_response_amplitude(r, branch, i + 1, output);
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

/* Frequency of a tracked branch at a value of the parameter; NAN beyond its ends. At a place that
 * the curve passes twice, the one nearest to a frequency. */
static double frequency_at(const mhb_branch *branch, double value, double near) {
  double best = NAN;
  for (int i = 0; i + 1 < branch->n_points; i++) {
    double from = branch->value[i], to = branch->value[i + 1];
    double slack = ROUNDED * fmax(fabs(from), fabs(to)); /* an end of the range is rounded */
    if (from == to || value < fmin(from, to) - slack || value > fmax(from, to) + slack) continue;
    for (int cubic = 0; cubic < 2; cubic++) { /* the line is better at a kink */
      double f = between(branch, i, value, cubic);
      if (isnan(best) || fabs(f - near) < fabs(best - near)) best = f;
    }
  }
  return best;
}

static bool is_known(const tracking_run *run, double value, double frequency) {
  for (int b = 0; b < run->response->n_branches; b++) {
    double f = frequency_at(&run->response->branch[b], value, frequency);
    if (fabs(f - frequency) <= ON_CURVE * frequency) return true;
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
static shb_status follow_with(tracking_run *run, const mhb_branch *from, int point, double value,
                              int m, bool *found, bool *good) {
  mhb_balance     *balance;
  mhb_tracking_end end;
  int              index;
  mhb_settings     settings = run->settings;
  mhb_tracking     tracking = run->tracking;
  bool             judge    = run->asked->harmonics == 0;
  settings.harmonics        = m;
  tracking.tolerance        = judge && m < MOST_HARMONICS ? run->asked->motion_tolerance : 0;
  SHB_TRY(mhb_response_branch(run->response, MHB_BRANCH_TRACKED, &index));
  run->response->branch[index].n_harmonics = m;
  SHB_TRY(mhb_balance_create(run->model, &settings, &balance));
  double    *x      = calloc((size_t)balance->n, sizeof *x);
  shb_status status = x ? SHB_OK : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status == SHB_OK) {
    const mhb_tracking_seed seed = {x, SHB_TWO_PI * from->frequency[point], value};
    mhb_recorded_motion(from, point, balance, x);
    status = mhb_trace_corner(balance, &run->tracking, &seed, run->response, index, found, &end);
    if (status == SHB_OK && !*found)
      status = mhb_trace_tracked(balance, &tracking, &seed, run->response, index, found, &end);
  }
  free(x);
  mhb_balance_destroy(balance);
  if (status != SHB_OK) return status;
  mhb_branch *branch = &run->response->branch[index];
  char        reason[200];
  snprintf(reason, sizeof reason, "%s; %s", end_text(end.low), end_text(end.high));
  branch->reason   = strdup(reason);
  branch->searched = branch->complete = true;
  *good                               = *found;
  for (int i = 0; i < branch->n_points && judge; i++)
    *good = *good && branch->error_truncation[i] <= run->asked->motion_tolerance;
  return SHB_OK;
}

/* Follow a point of a sweep with the fewest harmonics that suffice along all of its curve. One that
 * cannot be followed is lost; it counts if it is the highest of its sweep. */
static shb_status follow(tracking_run *run, const mhb_branch *from, int point, double value,
                         bool high) {
  int  fixed = run->asked->harmonics, m = fixed > 0 ? fixed : least_harmonics(run->asked);
  bool found = false, good = false;
  for (;; m = 2 * m + 1) {
    bool last = fixed > 0 || m >= MOST_HARMONICS;
    SHB_TRY(follow_with(run, from, point, value, m, &found, &good));
    if (good || (last && found) || shb_interrupted()) return SHB_OK;
    drop_last(run->response);
    if (last) break;
  }
  if (high && run->n_lost++ == 0) run->lost_at = value;
  return SHB_OK;
}

/* Follow the peaks of a sweep that are not known; most: its highest amplitude. */
static shb_status follow_all(tracking_run *run, const mhb_response *sweep, double value,
                             double most) {
  for (int b = 0; b < sweep->n_branches; b++) {
    const mhb_branch *branch = &sweep->branch[b];
    for (int i = 0; i < branch->n_points && branch->kind == MHB_BRANCH_NONLINEAR; i++) {
      if (!is_seed(run, sweep, branch, i, most) || is_known(run, value, branch->frequency[i]))
        continue;
      bool high = mhb_track_by_multiplier(run->response->track) ||
                  mhb_response_amplitude(sweep, branch, i, run->tracking.output) >= HIGHEST * most;
      SHB_TRY(follow(run, branch, i, value, high));
      if (shb_interrupted()) return SHB_OK;
    }
  }
  return SHB_OK;
}

/* ---- the work ---- */

static shb_status make_response(tracking_run *run, mhb_response *const sweep[N_SWEEPS]) {
  int fixed                      = run->asked->harmonics;
  run->settings.harmonics        = fixed > 0 ? fixed : MOST_HARMONICS;
  run->settings.motion_tolerance = 0;
  run->settings.stability        = MHB_STABILITY_NEVER;
  run->settings.n_preloads       = 1;
  run->response =
      mhb_response_create(run->model->n_pairs, run->model->n_probes, run->settings.harmonics);
  SHB_CHECK(run->response, SHB_ERR_IO, "out of memory");
  run->response->unfinished = true;
  run->response->track      = strdup(mhb_track_word(run->asked->track));
  run->response->output     = strdup(output_name(run));
  SHB_CHECK(run->response->track && run->response->output, SHB_ERR_IO, "out of memory");
  run->response->tracks_multiplier = mhb_track_by_multiplier(run->response->track);
  run->response->psi               = sweep[0]->psi;
  run->response->phi               = sweep[0]->phi;
  return mhb_response_describe(run->response, run->model, &run->settings);
}

/* A sweep at a value, and the curves through its peaks that are not known yet.
 *   most  out  highest amplitude of the sweep, m */
static shb_status sweep_and_follow(tracking_run *run, double value, bool coarse, double *most) {
  mhb_response *sweep = NULL;
  shb_progress_show(run->progress, 90, "sweep at %s %.6g %s",
                    mhb_parameter_name(run->tracking.parameter), value,
                    mhb_parameter_unit(run->tracking.parameter));
  shb_status status = sweep_at(run, value, coarse, &sweep);
  if (status == SHB_OK) *most = highest(run, sweep);
  if (status == SHB_OK) status = follow_all(run, sweep, value, *most);
  mhb_response_destroy(sweep);
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

/* Where a branch ends inside the range another peak takes over. A sweep beyond each such end finds
 * it, unless a known branch is as high there. */
static shb_status chain(tracking_run *run, int *budget) {
  for (int b = 0; b < run->response->n_branches; b++) {
    for (int end = 0; end < 2 && *budget > 0 && !shb_interrupted(); end++) {
      const mhb_branch *branch = &run->response->branch[b]; /* it moves when others are added */
      int               point  = end ? branch->n_points - 1 : 0;
      double            most, value = branch->value[point];
      if (!mhb_is_highest(&run->tracking, run->response, b, point, NEARLY_HIGHEST)) continue;
      if (value <= run->tracking.low || value >= run->tracking.high) continue;
      value += (end ? BEYOND : -BEYOND) * fabs(value);
      if (value <= run->tracking.low || value >= run->tracking.high) continue;
      if (goes_on(run, b, point, value)) continue;
      --*budget;
      SHB_TRY(sweep_and_follow(run, value, true, &most));
    }
  }
  return SHB_OK;
}

/* The optimum, until a sweep there finds no peak that is higher. */
static shb_status verified_optimum(tracking_run *run, int *budget) {
  while (!shb_interrupted()) {
    double most;
    int    before = run->response->n_branches;
    SHB_TRY(mhb_find_optimum(run->model, &run->settings, &run->tracking, run->response));
    mhb_optimum *optimum = &run->response->optimum;
    if (optimum->kind == MHB_OPTIMUM_NONE || (*budget)-- <= 0) return SHB_OK;
    SHB_TRY(sweep_and_follow(run, optimum->value, false, &most));
    optimum->verified = most <= optimum->amplitude * (1 + HIGHER);
    if (optimum->verified || run->response->n_branches == before) return SHB_OK;
    SHB_TRY(chain(run, budget));
  }
  return SHB_OK;
}

static shb_status run_all(tracking_run *run, mhb_response *sweep[N_SWEEPS]) {
  double value[N_SWEEPS];
  seed_values(&run->tracking, value);
  shb_progress_show(run->progress, 0, "sweeps at %d values of %s", N_SWEEPS,
                    mhb_parameter_name(run->tracking.parameter));
#pragma omp parallel for schedule(dynamic, 1)
  for (int i = 0; i < N_SWEEPS; i++) {
    shb_status status = shb_interrupted() ? SHB_OK : sweep_at(run, value[i], true, &sweep[i]);
    mhb_publisher_lock(&run->publisher, true);
    mhb_publisher_note(&run->publisher, status);
    mhb_publisher_lock(&run->publisher, false);
  }
  SHB_TRY(mhb_publisher_status(&run->publisher));
  if (shb_interrupted()) return SHB_OK;
  SHB_TRY(make_response(run, sweep));
  for (int i = 0; i < N_SWEEPS && !shb_interrupted(); i++) {
    shb_progress_show(run->progress, 20 + 80. * i / N_SWEEPS, "following from %s %.6g %s",
                      mhb_parameter_name(run->tracking.parameter), value[i],
                      mhb_parameter_unit(run->tracking.parameter));
    SHB_TRY(follow_all(run, sweep[i], value[i], highest(run, sweep[i])));
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
  int           output;
  mhb_response *sweep[N_SWEEPS] = {NULL};
  *out                          = NULL;
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
  shb_status status = run_all(&run, sweep);
  mhb_publisher_stop(&run.publisher);
  for (int i = 0; i < N_SWEEPS; i++) mhb_response_destroy(sweep[i]);
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
