#include "postproc/analysis/response_analysis.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/contact/law.h"
#include "postproc/draw/number_format.h"

double post_spatial_error(const mhb_branch *branch, int point) {
  const double *error = branch->kind == MHB_BRANCH_NONLINEAR ? branch->error_spatial : NULL;
  return error && error[point] >= 0 ? error[point] : NAN;
}

bool post_undetermined(const mhb_response *response, const mhb_branch *branch, int point) {
  return (branch->mark[point] & MHB_TRACTION_UNDETERMINED) &&
         post_state(response, branch, point, MHB_STICK) < 1;
}

double post_error(const mhb_branch *branch, int point) {
  const double *part[] = {branch->error_newton, branch->error_truncation, branch->error_sampling,
                          branch->error_modal};
  double        worst  = post_spatial_error(branch, point);
  for (int i = 0; i < 4; i++)
    if (isfinite(part[i][point])) worst = fmax(worst, part[i][point]); /* fmax ignores a NAN */
  return worst;
}

double post_state(const mhb_response *response, const mhb_branch *branch, int point, int state) {
  double sum = 0;
  for (int p = 0; p < response->n_pairs; p++)
    sum +=
        branch->state[((size_t)point * (size_t)response->n_pairs + (size_t)p) * 3 + (size_t)state];
  return response->n_pairs > 0 ? sum / response->n_pairs : NAN;
}

double post_dissipation(const mhb_response *response, const mhb_branch *branch, int point) {
  double sum = 0;
  for (int p = 0; p < response->n_pairs; p++) {
    const size_t at = (size_t)point * (size_t)response->n_pairs + (size_t)p;
    if (branch->state[3 * at + MHB_SLIDE] > 0) sum += branch->dissipation[at];
  }
  return sum;
}

void post_group_name(const post_group *group, char out[64]) {
  char number[POST_NUMBER];
  if (group->kind == MHB_BRANCH_OPEN)
    strcpy(out, "open");
  else if (group->kind == MHB_BRANCH_STUCK)
    strcpy(out, "stuck");
  else if (isnan(group->n0))
    strcpy(out, group->empty ? "no point" : "n₀ varying");
  else
    snprintf(out, 64, "n₀ = %s\u00a0N", post_plain(number, group->n0, 6));
}

void post_branch_note(const mhb_response *response, const mhb_branch *branch, char out[64]) {
  static const char *const origin[] = {"", ", isolated curve found by search", ", from a flip",
                                       ", isolated curve"};
  int                      order = branch->order / response->subharmonics, used = 0;
  out[0] = '\0';
  if (branch->origin != MHB_FROM_END && order > 1) used = snprintf(out, 64, ", order %d", order);
  snprintf(out + used, (size_t)(64 - used), "%s", origin[branch->origin]);
}

/* Points by time integration belong to the curves of their preload; tracked peaks are curves. */
static mhb_branch_kind group_kind(const mhb_branch *branch) {
  bool own = branch->kind == MHB_BRANCH_OPEN || branch->kind == MHB_BRANCH_STUCK;
  return own ? branch->kind : MHB_BRANCH_NONLINEAR;
}

bool post_at_one_frequency(const post_analysis *analysis) {
  return analysis->abscissa.parameter != MHB_IN_FREQUENCY;
}

char *post_frequency_text(const post_analysis *analysis, char out[POST_PLACE]) {
  char number[POST_NUMBER];
  out[0] = '\0';
  if (post_at_one_frequency(analysis) && !analysis->response->track)
    snprintf(out, POST_PLACE, " at %s\u00a0Hz", post_plain(number, analysis->frequency[0], 6));
  return out;
}

/* Preload of a branch; NAN if it varies, is the followed parameter, or there is no point. */
static double branch_n0(const mhb_response *response, const mhb_branch *branch) {
  if (response->parameter == MHB_IN_N0) return NAN;
  if (branch->n_points == 0 || group_kind(branch) != MHB_BRANCH_NONLINEAR) return NAN;
  double n0 = branch->n0[0];
  for (int p = 1; p < branch->n_points; p++)
    if (fabs(branch->n0[p] - n0) > 1e-9 * fmax(fabs(n0), fabs(branch->n0[p]))) return NAN;
  return n0;
}

static bool same_group(const post_group *a, const post_group *b) {
  if (a->kind != b->kind || (a->empty != b->empty && a->kind == MHB_BRANCH_NONLINEAR)) return false;
  if (isnan(a->n0) || isnan(b->n0)) return isnan(a->n0) && isnan(b->n0);
  return fabs(a->n0 - b->n0) <= 1e-9 * fmax(fabs(a->n0), fabs(b->n0));
}

/* Order: nonlinear by ascending n0, nonlinear with varying n0, open, stuck. */
static int order_groups(const void *left, const void *right) {
  const post_group *a = left, *b = right;
  if (a->kind != b->kind) return (int)a->kind - (int)b->kind;
  if (isnan(a->n0) || isnan(b->n0)) return (int)isnan(a->n0) - (int)isnan(b->n0);
  if (isnan(a->n0)) return (int)a->empty - (int)b->empty;
  return (a->n0 > b->n0) - (a->n0 < b->n0);
}

static int find_group(const post_analysis *analysis, const post_group *wanted) {
  for (int g = 0; g < analysis->n_groups; g++)
    if (same_group(&analysis->group[g], wanted)) return g;
  return -1;
}

static void make_groups(post_analysis *analysis) {
  const mhb_response *response = analysis->response;
  for (int pass = 0; pass < 2; pass++) {
    for (int b = 0; b < response->n_branches; b++) {
      const mhb_branch *branch = &response->branch[b];
      post_group wanted = {group_kind(branch), branch->n_points == 0, branch_n0(response, branch),
                           -1};
      int        at     = find_group(analysis, &wanted);
      if (at < 0) analysis->group[at = analysis->n_groups++] = wanted;
      analysis->curve[b].group = at; /* final in the second pass, after sorting */
    }
    if (pass == 0)
      qsort(analysis->group, (size_t)analysis->n_groups, sizeof *analysis->group, order_groups);
  }
  for (int g = 0; g < analysis->n_groups; g++)
    if (analysis->group[g].kind == MHB_BRANCH_NONLINEAR && !isnan(analysis->group[g].n0))
      analysis->group[g].rank = analysis->n_ranks++;
}

shb_status post_values(const mhb_response *response, post_output output, post_quantity quantity,
                       double ***values) {
  double **out = calloc((size_t)response->n_branches + 1, sizeof *out);
  SHB_CHECK(out, SHB_ERR_IO, "not enough memory for %d curves", response->n_branches);
  for (int b = 0; b < response->n_branches; b++) {
    shb_status status = post_series(response, &response->branch[b], output, quantity, &out[b]);
    if (status != SHB_OK) {
      post_values_free(response, out);
      return status;
    }
  }
  *values = out;
  return SHB_OK;
}

void post_values_free(const mhb_response *response, double **values) {
  for (int b = 0; values && b < response->n_branches; b++) free(values[b]);
  free(values);
}

/* Highest peak of one group. */
static shb_status track_group(const post_analysis *analysis, int group, double *const *values,
                              post_track_point *out) {
  *out = (post_track_point){analysis->group[group].n0, NAN, NAN, -1, -1, false, false, true, false};
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const mhb_branch *branch = &analysis->response->branch[b];
    if (analysis->curve[b].group != group || branch->kind == MHB_BRANCH_INTEGRATION) continue;
    out->complete = out->complete && branch->complete;
    post_peak    *peaks;
    int           n;
    const double *x = post_abscissa_values(analysis->response, branch);
    SHB_TRY(post_find_peaks(branch->n_points, x, values[b], &peaks, &n));
    int top = post_highest_peak(n, peaks);
    if (top >= 0 && !(peaks[top].amplitude <= out->amplitude)) {
      bool last      = peaks[top].level && branch->kind == MHB_BRANCH_STUCK;
      out->at        = last ? x[branch->n_points - 1] : peaks[top].at;
      out->amplitude = peaks[top].amplitude;
      out->edge      = peaks[top].edge;
      out->level     = peaks[top].level;
      out->branch    = b;
      out->point     = peaks[top].point;
      out->doubtful  = mhb_branch_marked(branch, out->point);
    }
    free(peaks);
  }
  return SHB_OK;
}

void post_tracking_optimum(bool any_edge, post_tracking *t) {
  t->best       = -1;
  t->bracket[0] = t->bracket[1] = t->optimum_n0 = t->optimum_amplitude = NAN;
  for (int edges = any_edge; edges <= 1 && t->best < 0; edges++)
    for (int i = 0; i < t->n; i++) {
      bool lower = t->best < 0 || t->point[i].amplitude < t->point[t->best].amplitude;
      if (lower && !t->point[i].doubtful && (edges || !t->point[i].edge)) t->best = i;
    }
  for (int i = 0; i < t->best; i++)
    if (!t->point[i].doubtful) t->bracket[0] = t->point[i].n0;
  for (int i = t->n - 1; t->best >= 0 && i > t->best; i--)
    if (!t->point[i].doubtful) t->bracket[1] = t->point[i].n0;
  if (isnan(t->bracket[0]) || isnan(t->bracket[1])) return;
  const post_track_point *p = &t->point[t->best - 1];
  for (int i = 0; i < 3; i++)
    if (p[i].edge || p[i].doubtful) return;
  bool   log_x = p[0].n0 > 0;
  double x[3], y[3];
  for (int i = 0; i < 3; i++) {
    x[i] = log_x ? log(p[i].n0) : p[i].n0;
    y[i] = log(p[i].amplitude);
  }
  double evenness = (x[2] - x[1]) / (x[1] - x[0]);
  if (evenness < 0.25 || evenness > 4) return;
  double d1            = (y[1] - y[0]) / (x[1] - x[0]),
         d2            = ((y[2] - y[1]) / (x[2] - x[1]) - d1) / (x[2] - x[0]);
  double at            = d2 > 0 ? (x[0] + x[1]) / 2 - d1 / (2 * d2) : x[1];
  t->optimum_n0        = log_x ? exp(at) : at;
  t->optimum_amplitude = exp(y[0] + (at - x[0]) * (d1 + (at - x[1]) * d2));
}

shb_status post_track(const post_analysis *analysis, double *const *values,
                      post_tracking *tracking) {
  post_track_point none = {NAN, NAN, NAN, -1, -1, false, false, false, false};
  *tracking             = (post_tracking){.open = none, .stuck = none};
  tracking->point       = calloc((size_t)analysis->n_groups, sizeof *tracking->point);
  SHB_CHECK(tracking->point, SHB_ERR_IO, "not enough memory for the tracking curve");
  for (int g = 0; g < analysis->n_groups; g++) {
    post_track_point point;
    shb_status       status = track_group(analysis, g, values, &point);
    if (status != SHB_OK) {
      post_tracking_free(tracking);
      return status;
    }
    if (analysis->group[g].kind == MHB_BRANCH_OPEN)
      tracking->open = point;
    else if (analysis->group[g].kind == MHB_BRANCH_STUCK)
      tracking->stuck = point;
    else if (analysis->group[g].rank >= 0 && point.amplitude > 0)
      tracking->point[tracking->n++] = point;
  }
  post_tracking_optimum(post_at_one_frequency(analysis), tracking);
  return SHB_OK;
}

void post_tracking_free(post_tracking *tracking) {
  free(tracking->point);
  *tracking = (post_tracking){0};
}

void post_resonances_free(post_resonances *r) {
  for (int i = 0; i < r->n; i++) post_tracking_free(&r->list[i]);
  free(r->list);
  *r = (post_resonances){0};
}

/* Minima: peaks of the reciprocal amplitude. */
static shb_status find_valleys(int n, const double *x, post_curve *c) {
  const double *amplitude  = c->amplitude;
  double       *reciprocal = malloc((size_t)(n > 0 ? n : 1) * sizeof *reciprocal);
  SHB_CHECK(reciprocal, SHB_ERR_IO, "not enough memory for a curve of %d points", n);
  for (int i = 0; i < n; i++) reciprocal[i] = 1 / fmax(amplitude[i], 1e-30);
  shb_status status = post_find_peaks(n, x, reciprocal, &c->valley, &c->n_valleys);
  free(reciprocal);
  for (int i = 0; i < c->n_valleys; i++) {
    post_peak *valley = &c->valley[i];
    valley->amplitude = amplitude[valley->point] > 0 ? 1 / valley->amplitude : 0;
  }
  return status;
}

static shb_status analyse_branch(post_analysis *analysis, int b) {
  const mhb_branch *branch = &analysis->response->branch[b];
  post_curve       *c      = &analysis->curve[b];
  int               n      = branch->n_points;
  c->amplitude             = analysis->values[b];
  const double *x          = post_abscissa_values(analysis->response, branch);
  if (branch->kind != MHB_BRANCH_INTEGRATION)
    SHB_TRY(post_find_peaks(n, x, c->amplitude, &c->peak, &c->n_peaks));
  if (post_at_one_frequency(analysis)) SHB_TRY(find_valleys(n, x, c));
  if (branch->kind == MHB_BRANCH_NONLINEAR)
    SHB_TRY(post_find_folds(n, x, c->amplitude, branch->special, &c->fold, &c->n_folds));
  for (int p = 0; p < n; p++) {
    analysis->frequency[0] = fmin(analysis->frequency[0], branch->frequency[p]);
    analysis->frequency[1] = fmax(analysis->frequency[1], branch->frequency[p]);
    analysis->largest      = fmax(analysis->largest, c->amplitude[p]);
  }
  analysis->n_points += n;
  return SHB_OK;
}

static shb_status fill_analysis(post_analysis *analysis) {
  SHB_CHECK(analysis->response->n_probes + analysis->response->n_pairs > 0, SHB_ERR_INPUT,
            "the response holds neither a probe nor a contact: nothing to show");
  make_groups(analysis);
  SHB_TRY(post_values(analysis->response, analysis->primary,
                      post_quantity_primary(analysis->response), &analysis->values));
  for (int b = 0; b < analysis->response->n_branches; b++) SHB_TRY(analyse_branch(analysis, b));
  SHB_CHECK(
      analysis->n_points > 0, SHB_ERR_INPUT,
      "the response holds no point on any branch: nothing to show; run the harmonic balance first");
  return post_track(analysis, analysis->values, &analysis->tracking);
}

shb_status post_analysis_create(const mhb_response *response, post_analysis **out) {
  size_t         n        = (size_t)response->n_branches;
  post_analysis *analysis = calloc(1, sizeof *analysis);
  SHB_CHECK(analysis, SHB_ERR_IO, "not enough memory for the report");
  analysis->response     = response;
  analysis->primary      = post_output_primary(response);
  analysis->abscissa     = post_abscissa_of(response);
  analysis->frequency[0] = INFINITY;
  analysis->frequency[1] = -INFINITY;
  analysis->group        = calloc(n + 1, sizeof *analysis->group);
  analysis->curve        = calloc(n + 1, sizeof *analysis->curve);
  shb_status status =
      analysis->group && analysis->curve
          ? fill_analysis(analysis)
          : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "not enough memory for the report");
  if (status != SHB_OK) {
    post_analysis_destroy(analysis);
    return status;
  }
  *out = analysis;
  return SHB_OK;
}

void post_analysis_destroy(post_analysis *analysis) {
  if (!analysis) return;
  for (int b = 0; analysis->curve && b < analysis->response->n_branches; b++) {
    free(analysis->curve[b].peak);
    free(analysis->curve[b].valley);
    free(analysis->curve[b].fold);
  }
  post_tracking_free(&analysis->tracking);
  post_resonances_free(&analysis->resonances);
  post_values_free(analysis->response, analysis->values);
  free(analysis->curve);
  free(analysis->group);
  free(analysis);
}

void post_put_harmonics(const mhb_response *response, post_buffer *out) {
  int fewest = response->n_harmonics, most = 0;
  for (int b = 0; b < response->n_branches; b++) {
    const mhb_branch *branch = &response->branch[b];
    if (branch->kind != MHB_BRANCH_NONLINEAR) continue;
    for (int p = 0; p < branch->n_points; p++) {
      int m = branch->harmonics[p] > 0 ? branch->harmonics[p] : response->n_harmonics;
      if (m < fewest) fewest = m;
      if (m > most) most = m;
    }
  }
  if (most == 0) most = response->n_harmonics;
  if (fewest < most) post_put(out, "%d to ", fewest);
  post_put(out, "%d harmonic%s", most, most == 1 ? "" : "s");
}

void post_put_run_up(const post_analysis *analysis, post_buffer *out) {
  const mhb_response *r = analysis->response;
  char                lo[POST_NUMBER], hi[POST_NUMBER];
  if (!r->run_up || !(analysis->frequency[0] <= analysis->frequency[1])) return;
  post_put(out, "run-up: speed %s",
           post_plain(lo, 60 * analysis->frequency[0] / r->engine_order, 6));
  if (analysis->frequency[0] < analysis->frequency[1])
    post_put(out, " to %s", post_plain(hi, 60 * analysis->frequency[1] / r->engine_order, 6));
  post_put(out, " rpm along E = %d", r->engine_order);
}
