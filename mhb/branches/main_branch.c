#include "mhb/branches/main_branch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/progress.h"
#include "mhb/branches/record.h"
#include "mhb/branches/tracer.h"
#include "mhb/continuation/first_solution.h"

enum { MAX_GAPS = 8, MAX_RETURNS = 8 };

/* Of the length in y: as near as this, what lies between two ends of a curve is a kink that no step passes. */
static const double ACROSS_KINK = 1e-2;

/* A main branch. */
typedef struct {
  mhb_tracer f;
  int        gaps; /* places jumped over */
  char       first_gap[96];
  int        start;                            /* the point where the curve under way begins */
  bool       turned;                           /* that is on the high end of the range */
  int        stable_at;                        /* the first solution found, stable by assumption */
  int        n_aside, aside[MHB_MAX_DETACHED]; /* branches split off */
  mhb_curve_start
      lost; /* where the curve was lost, to be come upon from the other side; or empty */
} trunk;

static const char INTERRUPTED[]    = "interrupted",
                  NOTHING_BEYOND[] = "no solution found beyond a curve that closes or turns back";

static bool is_complete(const char *reason) {
  return strcmp(reason, MHB_WHOLE) == 0 || strcmp(reason, MHB_CLOSED) == 0 ||
         strcmp(reason, MHB_JOINED) == 0;
}

/* A pair of folds that spans less than 1e-5 of the value, or of a hundredth of the range, is no jump that anyone could observe: not
 * marked. */
static void drop_hairlines(mhb_branch *branch, double range) {
  int last = -1;
  for (int i = 0; i < branch->n_points; i++) {
    if (branch->special[i] != MHB_FOLD) continue;
    double width = last < 0 ? INFINITY : fabs(branch->value[i] - branch->value[last]);
    if (width < 1e-5 * fmax(fabs(branch->value[i]), .01 * range)) {
      branch->special[i] = branch->special[last] = MHB_ORDINARY;
      last                                       = -1;
    } else {
      last = i;
    }
  }
}

static shb_status insert(mhb_branch_editor *host, mhb_curve_point *point, int special, int at) {
  mhb_tracer *f = (mhb_tracer *)host;
  mhb_harmonic_levels_errors(f->harmonics, point);
  host->lock(host, true);
  shb_status status = mhb_record(f->response, f->branch, f->residual, point, special, 0);
  if (status == SHB_OK) mhb_response_place(f->response, f->branch, at);
  host->lock(host, false);
  return status;
}

static void lock_judge(mhb_branch_editor *host, bool locked) {
  mhb_tracer *f = (mhb_tracer *)host;
  mhb_tracer_lock(f, locked);
}

static bool judged(mhb_branch_editor *host, double value) {
  mhb_tracer     *f     = (mhb_tracer *)host;
  mhb_curve_point point = {.value = value};
  return f->monitor->point(f->monitor, f->branch, &point);
}

/* Before the branch counts as complete: an interrupted run takes complete branches over as they are. */
static shb_status judge(mhb_tracer *f, bool stable_start, int stable_at, const char **reason) {
  bool finished = true;
  mhb_tracer_lock(f, true);
  drop_hairlines(&f->response->branch[f->branch],
                 mhb_parameter_shown(f->residual->parameter, f->path->high - f->path->low));
  if (stable_start) mhb_branch_stability_by_folds(&f->response->branch[f->branch], stable_at);
  mhb_tracer_lock(f, false);
  if (f->residual->settings->stability == MHB_STABILITY_NEVER || strcmp(*reason, INTERRUPTED) == 0)
    return SHB_OK;
  f->harmonics->at = f->harmonics->highest; /* no point has more */
  mhb_tracer_use_rung(f);
  mhb_tracer_lock(f, true); /* FFTW's planner */
  shb_status made = f->judge ? SHB_OK : mhb_branch_stability_create(f->residual, &f->judge);
  mhb_tracer_lock(f, false);
  SHB_TRY(made);
  f->host = (mhb_branch_editor){
      .insert = insert, .lock = lock_judge, .point = judged, .stable_at = stable_at};
  shb_status status = mhb_branch_stability_judge(f->judge, f->path, f->response, f->branch,
                                                 f->first, f->n_first, &f->host, &finished);
  if (!finished) *reason = INTERRUPTED;
  return status;
}

static shb_status set_reason(mhb_branch *branch, const char *reason, bool complete) {
  free(branch->reason);
  branch->reason   = strdup(reason);
  branch->complete = complete;
  SHB_CHECK(branch->reason, SHB_ERR_IO, "out of memory");
  return SHB_OK;
}

static shb_status end_branch(mhb_tracer *f, const char *reason) {
  mhb_tracer_lock(f, true);
  shb_status status = set_reason(&f->response->branch[f->branch], reason, is_complete(reason));
  mhb_tracer_lock(f, false);
  return status;
}

/* ---- the main branch ---- */

static int n_points(const mhb_tracer *f) {
  return f->response->branch[f->branch].n_points;
}

static void note_gap(trunk *t, const char *why, double value) {
  mhb_parameter parameter = t->f.residual->parameter;
  if (t->gaps++ == 0)
    snprintf(t->first_gap, sizeof t->first_gap, "%s at %.6g %s", why,
             mhb_parameter_shown(parameter, value), mhb_parameter_unit(parameter));
}

/* Forget the points from `from` on, and that a piece began there. */
static void cut(mhb_tracer *f, int from) {
  mhb_tracer_lock(f, true);
  f->response->branch[f->branch].n_points = from;
  mhb_tracer_lock(f, false);
  while (f->n_first > 0 && f->first[f->n_first - 1] >= from) f->n_first--;
}

/* The points from `from` on do not lead to the high end of the range: they become a branch of their own. */
static shb_status set_aside(trunk *t, int from, const char *reason) {
  mhb_tracer *f = &t->f;
  int         index;
  mhb_tracer_lock(f, true);
  shb_status status = mhb_response_branch(f->response, MHB_BRANCH_NONLINEAR, &index);
  if (status == SHB_OK) status = mhb_response_split(f->response, f->branch, from, index);
  if (status == SHB_OK) {
    mhb_branch *b = &f->response->branch[index];
    b->origin     = MHB_FROM_DETACHED;
    b->main       = f->branch;
    status        = set_reason(b, reason, true);
  }
  mhb_tracer_lock(f, false);
  SHB_TRY(status);
  cut(f, from);
  t->aside[t->n_aside++] = index;
  return SHB_OK;
}

static void swap_curves(mhb_curve_start *a, mhb_curve_start *b) {
  mhb_curve_start old = *a;
  *a                  = *b;
  *b                  = old;
}

static bool first_solution(mhb_tracer *f, double value) {
  int iterations;
  return mhb_first_solution(f->path->newton, f->residual, value, f->path->tolerance, f->x,
                            &iterations) == MHB_CONVERGED;
}

/* The points from `from` on, where a piece begins, in the opposite order. */
static void reverse(mhb_tracer *f, int from) {
  int n = n_points(f), last = f->n_first - 1;
  mhb_tracer_lock(f, true);
  mhb_response_reverse(f->response, f->branch, from);
  mhb_tracer_lock(f, false);
  for (int k = 0; k < f->n_first; k++)
    if (f->first[k] > from) f->first[k] = from + n - f->first[k];
  for (int k = 0; k < last; k++) /* ascending again */
    for (int j = k; j >= 0 && f->first[j] > f->first[j + 1]; j--) {
      int swap        = f->first[j];
      f->first[j]     = f->first[j + 1];
      f->first[j + 1] = swap;
    }
}

/* The points from `from` on lead down from a restart: onto the curve that was lost, or else to the low end of the range? */
static shb_status piece_before(trunk *t, int from, const char *why, bool *found) {
  mhb_tracer *f = &t->f;
  if (!t->lost.x && why == MHB_CLOSED && t->n_aside < MHB_MAX_DETACHED) {
    *found = false;
    return set_aside(t, from, why);
  }
  if (t->lost.x) {
    if (why != MHB_CLOSED &&
        mhb_curve_start_distance(&f->closed, f->path, &f->path->now) > ACROSS_KINK) {
      cut(f, from);
      t->start = from;
      return SHB_OK;
    }
    t->gaps--;
    f->n_first--; /* no piece of its own */
    if (why == MHB_CLOSED) cut(f, n_points(f) - 1);
  } else if (why != MHB_WHOLE) {
    note_gap(t, why, f->path->now.value);
  }
  const mhb_arclength *path = f->path;
  t->turned                 = why == MHB_WHOLE && path->next.value > .5 * (path->low + path->high);
  reverse(f, from);
  return SHB_OK;
}

/* A piece downwards from f->x, a solution at a value; then upwards from there. */
static shb_status both_ways(trunk *t, double value, bool *found, bool *go_on) {
  mhb_tracer *f    = &t->f;
  int         from = n_points(f), rung = f->harmonics->at;
  const char *why = NULL;
  SHB_TRY(mhb_tracer_begin(f, value, -1, true, found, go_on));
  if (!*found) return SHB_OK;
  if (!t->lost.x) t->start = from;
  t->turned = false;
  if (t->lost.x) swap_curves(&t->lost, &f->closed);
  f->either         = true;
  shb_status status = mhb_tracer_run(f, go_on, &why);
  f->either         = false;
  if (status == SHB_OK && *go_on) status = piece_before(t, from, why, found);
  if (t->lost.x) swap_curves(&t->lost, &f->closed);
  if (status != SHB_OK || !*found || !*go_on) return status;
  f->harmonics->at = rung;
  mhb_tracer_use_rung(f);
  return mhb_tracer_begin(f, value, 1, n_points(f) == from, found, go_on);
}

/* The curve goes on beyond what was reached. */
static shb_status restart(trunk *t, bool *found, bool *go_on) {
  static const double further[] = {1e-3, 3e-3, 1e-2, 3e-2, .1, .2, .4, .7};
  mhb_tracer         *f         = &t->f;
  double              span      = f->path->high - f->path->low;
  *found                        = false;
  for (int i = 0; i < 8 && !*found && *go_on && !shb_interrupted(); i++) {
    double value = f->farthest + further[i] * span;
    if (value >= f->path->high) break;
    if (first_solution(f, value)) SHB_TRY(both_ways(t, value, found, go_on));
  }
  return SHB_OK;
}

/* The curve ends before the high end of the range: what lies beyond. *end: why, if that is nothing. */
static shb_status go_beyond(trunk *t, const char *why, bool *go_on, const char **end) {
  mhb_tracer *f      = &t->f;
  bool        passed = why == MHB_CLOSED || why == MHB_TURNED_BACK, found;
  *end               = NULL;
  if (why == MHB_TURNED_BACK && t->turned) { /* from end to end, the other way */
    reverse(f, t->start);
    *end = MHB_WHOLE;
    return SHB_OK;
  }
  if (passed && t->n_aside < MHB_MAX_DETACHED) {
    SHB_TRY(set_aside(t, t->start, why));
  } else if (n_points(f) > 0) {
    note_gap(t, why, f->path->now.value);
    if (t->gaps > MAX_GAPS) *end = why;
    if (*end) return SHB_OK;
    SHB_TRY(mhb_curve_start_begin(&t->lost, f->path, mhb_tracer_closeness(f)));
    mhb_curve_start_turn(&t->lost);
  }
  shb_status status = restart(t, &found, go_on);
  mhb_curve_start_free(&t->lost);
  if (!found) *end = passed ? NOTHING_BEYOND : why;
  return status;
}

static shb_status run(trunk *t, const char **end) {
  mhb_tracer *f     = &t->f;
  bool        go_on = true, found = first_solution(f, f->path->low);
  const char *why = "no first solution";
  if (found) SHB_TRY(mhb_tracer_begin(f, f->path->low, 1, true, &found, &go_on));
  *end = NULL;
  if (!found) SHB_TRY(go_beyond(t, why, &go_on, end));
  while (go_on && !*end) {
    why = NULL;
    SHB_TRY(mhb_tracer_run(f, &go_on, &why));
    if (!go_on) break;
    bool over = why == MHB_WHOLE || n_points(f) >= f->residual->settings->max_points;
    if (over)
      *end = why;
    else
      SHB_TRY(go_beyond(t, why, &go_on, end));
  }
  if (!go_on) *end = INTERRUPTED;
  return SHB_OK;
}

/* The range is covered from end to end; what comes back into it behind the last point, at either end. */
static shb_status come_back_behind(trunk *t, bool *go_on) {
  mhb_tracer *f    = &t->f;
  bool        back = true;
  f->either        = true;
  for (int i = 0; i < MAX_RETURNS && back && *go_on; i++) {
    const char *why = NULL;
    SHB_TRY(mhb_tracer_return(f, &back, go_on));
    if (!back || !*go_on) break;
    SHB_TRY(mhb_tracer_run(f, go_on, &why));
    if (!*go_on || why == MHB_WHOLE) continue;
    if (why != MHB_CLOSED) note_gap(t, why, f->path->now.value);
    break;
  }
  f->either = false;
  return SHB_OK;
}

/* The same behind the last point, and before the first. */
static shb_status come_back_around(trunk *t, const char **end) {
  mhb_tracer *f     = &t->f;
  bool        go_on = true;
  SHB_TRY(come_back_behind(t, &go_on));
  int n = n_points(f);
  reverse(f, 0);
  if (go_on) SHB_TRY(come_back_behind(t, &go_on));
  t->stable_at = n_points(f) - n;
  reverse(f, 0);
  if (!go_on) *end = INTERRUPTED;
  return SHB_OK;
}

static shb_status finish_main(trunk *t, const char *reason) {
  mhb_tracer *f = &t->f;
  char        text[256];
  int         main = f->branch;
  SHB_TRY(judge(f, true, t->stable_at, &reason));
  for (int i = 0; i < t->n_aside && strcmp(reason, INTERRUPTED) != 0; i++) {
    const char *own = MHB_WHOLE;
    f->branch       = t->aside[i];
    f->first[0]     = 0;
    f->n_first      = 1;
    SHB_TRY(judge(f, false, 0, &own));
    if (own != MHB_WHOLE) reason = own;
  }
  f->branch = main;
  snprintf(text, sizeof text, "%s", reason);
  if (t->gaps > 0)
    snprintf(text, sizeof text, "%s, with %d gap%s: %s", reason, t->gaps, t->gaps > 1 ? "s" : "",
             t->first_gap);
  return end_branch(f, text);
}

shb_status mhb_trace_main_branch(mhb_balance *residual, mhb_response *response, int branch,
                                 mhb_monitor *monitor) {
  trunk       t      = {0};
  const char *why    = NULL;
  shb_status  status = mhb_tracer_create(&t.f, residual, response, branch, monitor);
  if (status == SHB_OK) status = run(&t, &why);
  if (status == SHB_OK && why == MHB_WHOLE) status = come_back_around(&t, &why);
  if (status == SHB_OK) status = finish_main(&t, why);
  mhb_tracer_destroy(&t.f);
  return status;
}

/* ---- a further branch ---- */

typedef struct {
  mhb_tracer       f;
  const mhb_start *start;
  int              home; /* the rung of the start */
} shoot;

/* The point of another curve that the branch leaves: its first. */
static shb_status record_crossing(shoot *s, bool *go_on) {
  mhb_tracer      *f     = &s->f;
  mhb_curve_point *point = &f->path->probe;
  memcpy(point->x, s->start->x, sizeof(double) * (size_t)f->path->n);
  point->value      = s->start->value;
  point->iterations = 0;
  mhb_tracer_revisit(f, point);
  point->residual = mhb_norm(f->path->newton->r, f->path->n) / mhb_norm(point->x, f->path->n);
  mhb_harmonic_levels_errors(f->harmonics, point);
  SHB_TRY(mhb_tracer_record(f, point, MHB_ORDINARY, go_on));
  mhb_tracer_revisit(f, &f->path->now);
  return SHB_OK;
}

/* Off the curve that is left. */
static shb_status depart(shoot *s, bool *found, bool *go_on) {
  mhb_tracer      *f     = &s->f;
  const mhb_start *start = s->start;
  *found = mhb_arclength_depart(f->path, start->x, start->value, start->along) == MHB_CONVERGED;
  if (!*found) return SHB_OK;
  SHB_TRY(record_crossing(s, go_on));
  SHB_TRY(mhb_tracer_arrive(f));
  return mhb_tracer_record(f, &f->path->now, MHB_ORDINARY, go_on);
}

/* Begin; the second time, the other way, the first point is there already. */
static shb_status begin_further(shoot *s, int direction, bool *found, bool *go_on) {
  mhb_tracer *f    = &s->f;
  f->harmonics->at = s->home;
  mhb_tracer_use_rung(f);
  if (s->start->along) return depart(s, found, go_on);
  memcpy(f->x, s->start->x, sizeof(double) * (size_t)f->path->n);
  return mhb_tracer_begin(f, s->start->value, direction, direction > 0, found, go_on);
}

/* One way; and, unless that closed the curve or began on another one, the other way. */
static shb_status run_further(shoot *s, const char **end, bool *none) {
  mhb_tracer *f     = &s->f;
  bool        go_on = true, found;
  const char *first = NULL;
  SHB_TRY(begin_further(s, 1, &found, &go_on));
  *none = !found;
  if (*none) return SHB_OK;
  SHB_TRY(mhb_tracer_run(f, &go_on, &first));
  *end = first;
  if (go_on && first != MHB_CLOSED && !s->start->along) {
    mhb_tracer_lock(f, true);
    mhb_response_reverse(f->response, f->branch, 0);
    mhb_tracer_lock(f, false);
    *end = NULL;
    SHB_TRY(begin_further(s, -1, &found, &go_on));
    mhb_curve_start_free(&f->closed); /* it does not */
    if (found) SHB_TRY(mhb_tracer_run(f, &go_on, end));
    if (!found || !is_complete(first)) *end = first;
  }
  if (!go_on) *end = INTERRUPTED;
  return SHB_OK;
}

shb_status mhb_trace_branch(mhb_balance *residual, mhb_response *response, int branch,
                            mhb_monitor *monitor, const mhb_start *start, bool *none) {
  shoot       s      = {.start = start};
  const char *why    = NULL;
  shb_status  status = mhb_tracer_create(&s.f, residual, response, branch, monitor);
  *none              = false;
  if (status == SHB_OK) {
    s.home     = s.f.harmonics->at;
    s.f.either = s.f.joins = true;
    status                 = run_further(&s, &why, none);
  }
  if (status == SHB_OK && !*none) status = judge(&s.f, false, 0, &why);
  if (status == SHB_OK && !*none) status = end_branch(&s.f, why);
  mhb_tracer_destroy(&s.f);
  return status;
}
