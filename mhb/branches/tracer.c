#include "mhb/branches/tracer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/progress.h"
#include "mhb/branches/record.h"
#include "mhb/continuation/corrector.h"
#include "mhb/continuation/outputs.h"

/* A path whose steps stay below CRAWL this often is as good as stalled. */
static const double CRAWL = 2e-3;
enum { MAX_CRAWL = 150, MAX_SHORTER = 5 };

/* A curve has closed if it comes as near as this to its beginning, relative to the motion. */
static const double SAME = 1e-5;

const char MHB_WHOLE[] = "end of range", MHB_CLOSED[] = "closed curve",
           MHB_JOINED[]      = "joins a curve of lower order",
           MHB_TURNED_BACK[] = "turned back to the start of the range";

void mhb_tracer_lock(const mhb_tracer *f, bool locked) {
  f->monitor->lock(f->monitor, locked);
}

shb_status mhb_tracer_record(mhb_tracer *f, mhb_curve_point *point, int special, bool *go_on) {
  double now = shb_seconds();
  mhb_tracer_lock(f, true);
  shb_status status =
      mhb_record(f->response, f->branch, f->residual, point, special, now - f->clock);
  if (status == SHB_OK) *go_on = f->monitor->point(f->monitor, f->branch, point);
  mhb_tracer_lock(f, false);
  f->clock = shb_seconds();
  return status;
}

static void slopes(const mhb_tracer *f, const mhb_curve_point *point, double *out) {
  for (int o = 0; o < f->n_outputs; o++) out[o] = mhb_output_slope(f->path, point, o);
}

void mhb_tracer_revisit(mhb_tracer *f, const mhb_curve_point *point) {
  mhb_newton *w = f->path->newton;
  mhb_balance_linearise(f->residual, point->x, point->value, w->r, NULL);
}

/* Leaves the residual's workspace at next, as mhb_arclength_step did. */
static shb_status record_landmarks(mhb_tracer *f, bool *go_on) {
  const mhb_special_points *l = &f->landmarks;
  for (int i = 0; i < l->n && *go_on; i++) {
    mhb_special_points_visit(l, f->path, i);
    mhb_harmonic_levels_errors(f->harmonics, &f->path->probe);
    SHB_TRY(mhb_tracer_record(f, &f->path->probe, l->mark[i].special, go_on));
  }
  if (l->away) mhb_tracer_revisit(f, &f->path->next);
  return SHB_OK;
}

/* The point recorded next does not follow the one before along the curve. */
static void begin_anew(mhb_tracer *f) {
  if (f->n_first < MHB_MAX_BEGINS) f->first[f->n_first++] = f->response->branch[f->branch].n_points;
}

void mhb_tracer_use_rung(mhb_tracer *f) {
  f->residual = mhb_harmonic_levels_current(f->harmonics)->residual;
  f->path     = mhb_harmonic_levels_current(f->harmonics)->path;
}

static shb_status make_rung(mhb_tracer *f, int rung) {
  mhb_tracer_lock(f, true); /* FFTW's planner */
  shb_status status = mhb_harmonic_levels_make(f->harmonics, rung);
  mhb_tracer_lock(f, false);
  return status;
}

/* Go on from now with another number of harmonics. *moved: 0 if that cannot be. */
static shb_status move(mhb_tracer *f, int rung, int step, int *moved) {
  SHB_TRY(make_rung(f, rung));
  *moved = mhb_harmonic_levels_move(f->harmonics, rung, step) == MHB_CONVERGED;
  if (!*moved) return SHB_OK;
  mhb_tracer_use_rung(f);
  slopes(f, &f->path->now, f->before);
  return SHB_OK;
}

/* A step at a number of harmonics that suffices at its end: where it does not, the step is taken anew from now, with more.
 * The errors of next are estimated. */
static shb_status sufficient_step(mhb_tracer *f, mhb_arclength_outcome *outcome) {
  for (int moved = 1;;) {
    *outcome = mhb_arclength_step(f->path);
    if (*outcome == MHB_ARCLENGTH_STALLED) return SHB_OK;
    mhb_harmonic_levels_estimate(f->harmonics, &f->path->next);
    int higher = mhb_harmonic_levels_higher(f->harmonics);
    if (higher < 0 || !moved) return SHB_OK;
    SHB_TRY(move(f, higher, 0, &moved));
  }
}

/* The start of a curve: now at a number of harmonics that suffices, errors estimated. */
static shb_status sufficient_start(mhb_tracer *f) {
  for (int moved = 1;;) {
    mhb_harmonic_levels_estimate(f->harmonics, &f->path->now);
    mhb_harmonic_levels_accept(f->harmonics);
    int higher = mhb_harmonic_levels_higher(f->harmonics);
    if (higher < 0 || !moved) return SHB_OK;
    SHB_TRY(move(f, higher, 1, &moved));
  }
}

double mhb_tracer_closeness(const mhb_tracer *f) {
  return fmax(SAME, 20 * f->residual->settings->motion_tolerance);
}

shb_status mhb_tracer_arrive(mhb_tracer *f) {
  slopes(f, &f->path->now, f->before);
  return sufficient_start(f);
}

shb_status mhb_tracer_begin(mhb_tracer *f, double value, int direction, bool recorded, bool *found,
                            bool *go_on) {
  f->crawling = 0;
  *found      = mhb_arclength_start(f->path, f->x, value, direction) == MHB_CONVERGED;
  if (!*found) return SHB_OK;
  f->farthest = fmax(f->farthest, value);
  mhb_curve_start_free(&f->closed);
  SHB_TRY(mhb_curve_start_begin(&f->closed, f->path, mhb_tracer_closeness(f)));
  SHB_TRY(mhb_tracer_arrive(f));
  if (!recorded) return SHB_OK;
  begin_anew(f);
  return mhb_tracer_record(f, &f->path->now, MHB_ORDINARY, go_on);
}

/* Why the curve ends at next; NULL: it does not. A curve that leaves by the low end and may come back is set on its way back. */
static const char *end_at(mhb_tracer *f, mhb_arclength_outcome outcome) {
  f->crawling = f->path->step < CRAWL ? f->crawling + 1 : 0;
  if (outcome == MHB_ARCLENGTH_STALLED) return "no step converged";
  if (outcome == MHB_ARCLENGTH_AT_END || (f->either && outcome == MHB_ARCLENGTH_AT_START))
    return MHB_WHOLE;
  if (f->closed.x && mhb_curve_start_passes(&f->closed, f->path)) {
    mhb_harmonic_levels_errors(f->harmonics, &f->path->next);
    return MHB_CLOSED;
  }
  return f->crawling > MAX_CRAWL ? "the steps stayed tiny" : NULL;
}

/* The motion recorded at a point of any curve is that of path->next, as near as a curve comes to itself. */
static bool is_recorded(const mhb_tracer *f, const mhb_branch *b, int point) {
  const mhb_balance    *r = f->residual;
  int                   K = b->n_harmonics + 1, rows = 3 * r->n_pairs;
  const double complex *A    = b->motion + (size_t)point * (size_t)rows * (size_t)K;
  double                away = 0, size = 0;
  for (int row = 0; row < rows; row++)
    for (int k = 0; k < K || k <= r->m; k++) {
      const double  *x    = f->path->next.x + (size_t)row * (size_t)r->nb;
      double complex here = k > r->m ? 0 : k ? CMPLX(x[2 * k - 1], x[2 * k]) : x[0];
      double complex then = k < K ? A[row * K + k] : 0;
      away += pow(cabs(here - then), 2);
      size += pow(cabs(here), 2);
    }
  return sqrt(away) <= 10 * mhb_tracer_closeness(f) * sqrt(size);
}

/* path->next, on an end of the range, has been passed before: by this curve, or by one set aside. */
static bool is_known(mhb_tracer *f) {
  const mhb_response *r     = f->response;
  double              value = mhb_parameter_shown(f->residual->parameter, f->path->next.value);
  bool                known = false;
  mhb_tracer_lock(f, true);
  for (int i = 0; i < r->n_branches && !known; i++) {
    const mhb_branch *b = &r->branch[i];
    if (b->kind != MHB_BRANCH_NONLINEAR || b->main != r->branch[f->branch].main) continue;
    for (int p = 0; p < b->n_points && !known; p++)
      known = fabs(b->value[p] - value) <= 1e-12 * fabs(value) && is_recorded(f, b, p);
  }
  mhb_tracer_lock(f, false);
  return known;
}

/* The curve is back in the range at path->next, which is to be recorded and followed from. */
static shb_status begin_back(mhb_tracer *f, bool *go_on) {
  mhb_arclength_advance(f->path);
  begin_anew(f);
  SHB_TRY(mhb_tracer_arrive(f));
  return mhb_tracer_record(f, &f->path->now, MHB_ORDINARY, go_on);
}

/* next, recorded, is on the low end of the range: go on where the curve comes back into it. */
static shb_status come_back(mhb_tracer *f, bool *go_on, const char **end) {
  if (mhb_arclength_excursion(f->path, MHB_ARCLENGTH_AT_START) != MHB_ARCLENGTH_ON)
    *end = MHB_TURNED_BACK;
  if (!*end && f->closed.x &&
      mhb_curve_start_distance(&f->closed, f->path, &f->path->next) <= f->closed.tolerance)
    *end = MHB_CLOSED;
  return *end ? SHB_OK : begin_back(f, go_on);
}

/* Begin at the last recorded point of the branch, as it was solved. */
static shb_status begin_at_last(mhb_tracer *f, int direction, bool *found) {
  const mhb_branch *b    = &f->response->branch[f->branch];
  int               last = b->n_points - 1, rung = 0;
  while (rung + 1 < f->harmonics->n && f->harmonics->m[rung] < b->harmonics[last]) rung++;
  SHB_TRY(make_rung(f, rung));
  f->harmonics->at = rung;
  mhb_tracer_use_rung(f);
  const mhb_balance *r = f->residual;
  mhb_recorded_motion(b, last, r, f->x);
  double value = mhb_parameter_value(r->parameter, b->value[last]);
  value        = direction < 0 ? fmax(value, f->path->low) : fmin(value, f->path->high);
  f->crawling  = 0;
  *found       = mhb_arclength_start(f->path, f->x, value, direction) == MHB_CONVERGED;
  return SHB_OK;
}

shb_status mhb_tracer_return(mhb_tracer *f, bool *back, bool *go_on) {
  const mhb_branch *b    = &f->response->branch[f->branch];
  double            last = b->value[b->n_points - 1];
  double            lo   = mhb_parameter_shown(f->residual->parameter, f->path->low),
         hi              = mhb_parameter_shown(f->residual->parameter, f->path->high);
  bool low = fabs(last - lo) <= 1e-9 * (hi - lo), high = fabs(last - hi) <= 1e-9 * (hi - lo);
  *back = low || high;
  if (*back) SHB_TRY(begin_at_last(f, low ? -1 : 1, back));
  mhb_curve_start_free(&f->closed);
  *back = *back &&
          mhb_arclength_excursion_within_budget(
              f->path, low ? MHB_ARCLENGTH_AT_START : MHB_ARCLENGTH_AT_END) == MHB_ARCLENGTH_ON;
  *back = *back && !is_known(f);
  if (!*back) return SHB_OK;
  SHB_TRY(begin_back(f, go_on));
  return mhb_curve_start_begin(&f->closed, f->path, mhb_tracer_closeness(f));
}

/* A step, why the curve ends there, and its folds and peaks, not yet recorded. */
static shb_status look_ahead(mhb_tracer *f, mhb_arclength_outcome *outcome, const char **end,
                             bool *folds_hidden) {
  *folds_hidden = false;
  SHB_TRY(sufficient_step(f, outcome));
  *end = end_at(f, *outcome);
  if (*outcome == MHB_ARCLENGTH_STALLED) return SHB_OK;
  slopes(f, &f->path->next, f->after);
  mhb_special_points_find(&f->landmarks, f->path, f->n_outputs, f->before, f->after);
  *folds_hidden = !*end && mhb_special_points_miss_fold(&f->landmarks, f->path);
  return SHB_OK;
}

/* From now to next. */
static double length(const mhb_arclength *path) {
  for (int i = 0; i < path->n; i++) path->chord[i] = path->next.x[i] - path->now.x[i];
  path->chord[path->n] = path->next.value - path->now.value;
  return sqrt(mhb_arclength_inner(path, mhb_arclength_unit(path), path->chord, path->chord));
}

/* The same, with shorter steps where folds are hidden in it; as it was if that does not help. */
static shb_status open_step(mhb_tracer *f, mhb_arclength_outcome *outcome, const char **end) {
  bool hidden;
  SHB_TRY(look_ahead(f, outcome, end, &hidden));
  if (!hidden) return SHB_OK;
  double whole = length(f->path), part = whole;
  for (int i = 0; i < MAX_SHORTER; i++) {
    f->path->step = part *= .25;
    SHB_TRY(look_ahead(f, outcome, end, &hidden));
    if (!hidden && *outcome != MHB_ARCLENGTH_STALLED) return SHB_OK;
  }
  f->path->step = whole;
  return look_ahead(f, outcome, end, &hidden);
}

shb_status mhb_tracer_step(mhb_tracer *f, bool *go_on, const char **end) {
  mhb_arclength_outcome outcome;
  if (f->joins && mhb_subharmonic_part_vanishes(f->path)) *end = MHB_JOINED;
  if (*end) return SHB_OK;
  SHB_TRY(open_step(f, &outcome, end));
  if (outcome == MHB_ARCLENGTH_STALLED) return SHB_OK;
  SHB_TRY(record_landmarks(f, go_on));
  int special = f->landmarks.unmarked ? MHB_FOLD : MHB_ORDINARY; /* as near as it is known */
  if (*go_on) SHB_TRY(mhb_tracer_record(f, &f->path->next, special, go_on));
  f->farthest = fmax(f->farthest, f->path->next.value);
  if (*end || !*go_on) return SHB_OK;
  if (outcome == MHB_ARCLENGTH_AT_START) return come_back(f, go_on, end);
  mhb_arclength_advance(f->path);
  mhb_harmonic_levels_accept(f->harmonics);
  double *swap = f->before;
  f->before    = f->after;
  f->after     = swap;
  int lower    = mhb_harmonic_levels_lower(f->harmonics), moved;
  return lower < 0 ? SHB_OK : move(f, lower, 0, &moved);
}

shb_status mhb_tracer_run(mhb_tracer *f, bool *go_on, const char **end) {
  int most = f->residual->settings->max_points;
  while (*go_on && !*end) {
    if (f->response->branch[f->branch].n_points >= most) *end = "mhb.max_points reached";
    if (!*end) SHB_TRY(mhb_tracer_step(f, go_on, end));
  }
  return SHB_OK;
}

shb_status mhb_tracer_create(mhb_tracer *f, mhb_balance *residual, mhb_response *response,
                             int branch, mhb_monitor *monitor) {
  const mhb_settings *s = residual->settings;
  *f                    = (mhb_tracer){.residual  = residual,
                                       .response  = response,
                                       .branch    = branch,
                                       .monitor   = monitor,
                                       .n_outputs = mhb_outputs(residual),
                                       .clock     = shb_seconds(),
                                       .farthest  = mhb_parameter_end(s, residual->parameter, 0)};
  size_t outputs        = (size_t)f->n_outputs + 1;
  mhb_tracer_lock(f, true); /* FFTW's planner */
  shb_status status = mhb_harmonic_levels_create(residual, &f->harmonics);
  mhb_tracer_lock(f, false);
  SHB_TRY(status);
  mhb_tracer_use_rung(f);
  f->before = calloc(outputs, sizeof(double));
  f->after  = calloc(outputs, sizeof(double));
  f->x      = calloc((size_t)mhb_harmonic_levels_most_unknowns(f->harmonics), sizeof(double));
  SHB_CHECK(f->before && f->after && f->x, SHB_ERR_IO, "out of memory");
  return mhb_special_points_create(&f->landmarks, mhb_harmonic_levels_most_unknowns(f->harmonics));
}

void mhb_tracer_destroy(mhb_tracer *f) {
  mhb_tracer_lock(f, true);
  mhb_branch_stability_destroy(f->judge);
  mhb_harmonic_levels_destroy(f->harmonics);
  mhb_tracer_lock(f, false);
  mhb_curve_start_free(&f->closed);
  mhb_special_points_destroy(&f->landmarks);
  free(f->before);
  free(f->after);
  free(f->x);
}
