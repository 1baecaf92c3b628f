#include "mhb/follow.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/progress.h"
#include "mhb/closed.h"
#include "mhb/harmonics.h"
#include "mhb/judge.h"
#include "mhb/locate.h"
#include "mhb/orders.h"
#include "mhb/record.h"

/* A path whose steps stay below CRAWL this often is as good as stalled. */
static const double CRAWL = 2e-3;

/* A curve has closed if it comes as near as this to its beginning, relative to the motion. */
static const double SAME = 1e-5;
enum { MAX_CRAWL = 150, MAX_GAPS = 8, MAX_BEGINS = 64 };

/* A branch under way. */
typedef struct {
  mhb_judge_host   host; /* first: the callbacks get it back */
  mhb_harmonics   *harmonics;
  mhb_residual    *residual; /* of the rung in use, as the path */
  mhb_path        *path;
  mhb_response    *response;
  int              branch;
  mhb_monitor     *monitor;
  int              n_outputs;
  double          *before, *after; /* [outputs] slopes of the amplitudes at now and next */
  double          *x;              /* [n] a first solution */
  double           clock;
  double           farthest;       /* highest value of the parameter reached */
  int              crawling, gaps; /* tiny steps in a row; places jumped over */
  char             first_gap[96];
  int              first[MAX_BEGINS], n_first; /* where the curve begins, and begins anew */
  mhb_judge       *judge;                      /* NULL: stability by folds */
  const mhb_start *start;                      /* of a further branch; NULL: the end of the range */
  mhb_closed_curve closed;                     /* where it began; empty: it cannot close */
  int              home;                       /* the rung of its start */
} follower;

/* How a branch ends that is complete. */
static const char WHOLE[] = "end of range", CLOSED[] = "closed curve",
                  JOINED[] = "joins a curve of lower order";

static double fold_indicator(const mhb_path *path, const mhb_path_point *point, void *context) {
  (void)context;
  return point->tangent[path->n];
}

static double peak_indicator(const mhb_path *path, const mhb_path_point *point, void *context) {
  return mhb_output_slope(path, point, *(const int *)context);
}

/* Record a point whose errors are estimated; false: stop. */
static shb_status record(follower *f, mhb_path_point *point, int special, bool *go_on) {
  double now = shb_seconds();
  f->monitor->lock(f->monitor, true);
  shb_status status =
      mhb_record(f->response, f->branch, f->residual, point, special, now - f->clock);
  if (status == SHB_OK) *go_on = f->monitor->point(f->monitor, f->branch, point);
  f->monitor->lock(f->monitor, false);
  f->clock = shb_seconds();
  return status;
}

static void slopes(const follower *f, const mhb_path_point *point, double *out) {
  for (int o = 0; o < f->n_outputs; o++) out[o] = mhb_output_slope(f->path, point, o);
}

static bool is_complete(const char *reason) {
  return strcmp(reason, WHOLE) == 0 || strcmp(reason, CLOSED) == 0 || strcmp(reason, JOINED) == 0;
}

/* An event between now and next: what, and where on the chord. */
typedef struct {
  int    special, output;
  double fraction;
} event;

enum { MAX_EVENTS = 16 };

static int by_fraction(const void *a, const void *b) {
  double x = ((const event *)a)->fraction, y = ((const event *)b)->fraction;
  return (x > y) - (x < y);
}

/* Folds (the frequency turns) and peaks (an amplitude turns down), by linear interpolation of their indicators. */
static int list_events(const follower *f, event *list) {
  const mhb_path *path = f->path;
  int             n = 0, last = path->n;
  double          a = path->now.tangent[last], b = path->next.tangent[last];
  if (a * b < 0) list[n++] = (event){MHB_FOLD, 0, a / (a - b)};
  for (int o = 0; o < f->n_outputs && n < MAX_EVENTS; o++) {
    double up = f->before[o], down = f->after[o];
    if (up > 0 && down < 0) list[n++] = (event){MHB_PEAK, o, up / (up - down)};
  }
  qsort(list, (size_t)n, sizeof *list, by_fraction);
  return n;
}

/* Leave the residual's workspace at a point that was corrected earlier. */
static void revisit(follower *f, const mhb_path_point *point) {
  mhb_newton *w = f->path->newton;
  mhb_residual_derive(f->residual, point->x, point->value, w->r, NULL);
}

/* Leaves the residual's workspace at next, as mhb_path_step did. */
static shb_status record_events(follower *f, bool *go_on) {
  event list[MAX_EVENTS];
  int   n = list_events(f, list), last = f->path->n;
  for (int i = 0; i < n && *go_on; i++) {
    int    fold = list[i].special == MHB_FOLD;
    double lo   = fold ? f->path->now.tangent[last] : f->before[list[i].output];
    double hi   = fold ? f->path->next.tangent[last] : f->after[list[i].output];
    double at;
    if (!mhb_path_locate(f->path, fold ? fold_indicator : peak_indicator, &list[i].output, lo, hi,
                         &at))
      continue;
    mhb_harmonics_errors(f->harmonics, &f->path->probe);
    SHB_TRY(record(f, &f->path->probe, list[i].special, go_on));
  }
  if (n > 0) revisit(f, &f->path->next);
  return SHB_OK;
}

/* The point recorded next does not follow the one before along the curve. */
static void begin_anew(follower *f) {
  if (f->n_first < MAX_BEGINS) f->first[f->n_first++] = f->response->branch[f->branch].n_points;
}

static void use_rung(follower *f) {
  f->residual = mhb_harmonics_rung(f->harmonics)->residual;
  f->path     = mhb_harmonics_rung(f->harmonics)->path;
}

/* Go on from now with another number of harmonics. *moved: 0 if that cannot be. */
static shb_status move(follower *f, int rung, int step, int *moved) {
  f->monitor->lock(f->monitor, true); /* FFTW's planner */
  shb_status status = mhb_harmonics_make(f->harmonics, rung);
  f->monitor->lock(f->monitor, false);
  SHB_TRY(status);
  *moved = mhb_harmonics_move(f->harmonics, rung, step) == MHB_CONVERGED;
  if (!*moved) return SHB_OK;
  use_rung(f);
  slopes(f, &f->path->now, f->before);
  return SHB_OK;
}

/* A step at a number of harmonics that suffices at its end: where it does not, the step is taken anew from now, with more.
 * The errors of next are estimated. */
static shb_status sufficient_step(follower *f, mhb_path_outcome *outcome) {
  for (int moved = 1;;) {
    *outcome = mhb_path_step(f->path);
    if (*outcome == MHB_PATH_STALLED) return SHB_OK;
    mhb_harmonics_estimate(f->harmonics, &f->path->next);
    int higher = mhb_harmonics_higher(f->harmonics);
    if (higher < 0 || !moved) return SHB_OK;
    SHB_TRY(move(f, higher, 0, &moved));
  }
}

/* The start of a curve: now at a number of harmonics that suffices, errors estimated. */
static shb_status sufficient_start(follower *f) {
  for (int moved = 1;;) {
    mhb_harmonics_estimate(f->harmonics, &f->path->now);
    int higher = mhb_harmonics_higher(f->harmonics);
    if (higher < 0 || !moved) return SHB_OK;
    SHB_TRY(move(f, higher, 1, &moved));
  }
}

/* Start, or start again, from a solution at a value of the parameter. */
static shb_status begin(follower *f, double value, bool *found, bool *go_on) {
  mhb_path  *path = f->path;
  int        iterations;
  mhb_reason reason =
      mhb_first_solution(path->newton, f->residual, value, path->tolerance, f->x, &iterations);
  if (reason == MHB_CONVERGED) reason = mhb_path_start(path, f->x, value, 1);
  *found = reason == MHB_CONVERGED;
  if (!*found) return SHB_OK;
  f->farthest = fmax(f->farthest, value);
  f->crawling = 0;
  begin_anew(f);
  slopes(f, &path->now, f->before);
  SHB_TRY(sufficient_start(f));
  return record(f, &f->path->now, MHB_ORDINARY, go_on);
}

/* The curve goes on beyond a place that cannot be passed; the reason will tell. */
static shb_status skip(follower *f, const char *why, bool *found, bool *go_on) {
  static const double further[] = {1e-3, 3e-3, 1e-2, 3e-2, .1};
  mhb_parameter       parameter = f->residual->parameter;
  double              from = f->farthest, span = f->path->high - f->path->low;
  *found = false;
  if (f->gaps == 0)
    snprintf(f->first_gap, sizeof f->first_gap, "%s at %.6g %s", why,
             mhb_parameter_shown(parameter, from), mhb_parameter_unit(parameter));
  if (f->gaps++ == MAX_GAPS) return SHB_OK;
  for (int i = 0; i < 5 && !*found; i++) {
    double value = from + further[i] * span;
    if (value >= f->path->high) break;
    SHB_TRY(begin(f, value, found, go_on));
  }
  return SHB_OK;
}

/* Why the path cannot be followed from here; NULL: it can. */
static const char *obstacle(follower *f, mhb_path_outcome outcome) {
  f->crawling = f->path->step < CRAWL ? f->crawling + 1 : 0;
  if (outcome == MHB_PATH_STALLED) return "no step converged";
  if (outcome == MHB_PATH_AT_START) {
    if (mhb_path_outside(f->path, outcome) != MHB_PATH_ON)
      return "turned back to the start of the range";
    slopes(f, &f->path->next, f->after);
    begin_anew(f);
  }
  return f->crawling > MAX_CRAWL ? "the steps stayed tiny" : NULL;
}

/* Why a further branch ends at next; NULL: it does not. */
static const char *end_of_further(follower *f, mhb_path_outcome outcome) {
  if (outcome == MHB_PATH_STALLED) return "no step converged";
  if (outcome != MHB_PATH_ON) return WHOLE;
  if (!f->closed.x || !mhb_closed_passes(&f->closed, f->path)) return NULL;
  mhb_harmonics_errors(f->harmonics, &f->path->next);
  return CLOSED;
}

/* One step and what lies on it; *end is set to the reason when the branch is done. */
static shb_status step(follower *f, bool *go_on, const char **end) {
  mhb_path_outcome outcome;
  bool             found = true;
  if (f->start && mhb_closed_joins(f->path)) *end = JOINED;
  if (*end) return SHB_OK;
  SHB_TRY(sufficient_step(f, &outcome));
  mhb_path *path = f->path;
  if (f->start) *end = end_of_further(f, outcome);
  if (outcome != MHB_PATH_STALLED) {
    slopes(f, &path->next, f->after);
    SHB_TRY(record_events(f, go_on));
    if (!*go_on) return SHB_OK;
    SHB_TRY(record(f, &path->next, MHB_ORDINARY, go_on));
    f->farthest = fmax(f->farthest, path->next.value);
  }
  if (outcome == MHB_PATH_AT_END) *end = WHOLE;
  if (*end || !*go_on) return SHB_OK;
  const char *why = obstacle(f, outcome);
  if (why && f->start) *end = why;
  if (*end) return SHB_OK;
  if (why) {
    SHB_TRY(skip(f, why, &found, go_on));
    if (!found) *end = why;
    return SHB_OK;
  }
  mhb_path_advance(path);
  double *swap = f->before;
  f->before    = f->after;
  f->after     = swap;
  int lower    = mhb_harmonics_lower(f->harmonics), moved;
  return lower < 0 ? SHB_OK : move(f, lower, 0, &moved);
}

static const char *run(follower *f, int max_points, shb_status *status) {
  bool        go_on = true, found;
  const char *end   = NULL;
  *status           = begin(f, f->path->low, &found, &go_on);
  if (*status == SHB_OK && !found) {
    *status = skip(f, "no first solution", &found, &go_on);
    if (*status == SHB_OK && !found) return "no first solution";
  }
  while (*status == SHB_OK && go_on && !end) {
    if (f->response->branch[f->branch].n_points >= max_points) return "mhb.max_points reached";
    *status = step(f, &go_on, &end);
  }
  return go_on ? end : "interrupted";
}

/* The point of another curve that the branch leaves: its first. */
static shb_status record_crossing(follower *f, bool *go_on) {
  mhb_path_point *point = &f->path->probe;
  memcpy(point->x, f->start->x, sizeof(double) * (size_t)f->path->n);
  point->value      = f->start->value;
  point->iterations = 0;
  revisit(f, point);
  point->residual = mhb_norm(f->path->newton->r, f->path->n) / mhb_norm(point->x, f->path->n);
  mhb_harmonics_errors(f->harmonics, point);
  SHB_TRY(record(f, point, MHB_ORDINARY, go_on));
  revisit(f, &f->path->now);
  return SHB_OK;
}

/* Begin a further branch; the second time, the other way, its first point is there already. */
static shb_status begin_further(follower *f, int direction, bool again, bool *found, bool *go_on) {
  const mhb_start *start = f->start;
  f->harmonics->at       = f->home;
  f->crawling            = 0;
  use_rung(f);
  mhb_reason reason = start->along ? mhb_path_depart(f->path, start->x, start->value, start->along)
                                   : mhb_path_start(f->path, start->x, start->value, direction);
  *found            = reason == MHB_CONVERGED;
  if (!*found) return SHB_OK;
  if (start->along) SHB_TRY(record_crossing(f, go_on));
  slopes(f, &f->path->now, f->before);
  SHB_TRY(sufficient_start(f));
  if (again) return SHB_OK;
  SHB_TRY(record(f, &f->path->now, MHB_ORDINARY, go_on));
  double tolerance = fmax(SAME, 20 * f->residual->settings->motion_tolerance);
  return start->along ? SHB_OK : mhb_closed_begin(&f->closed, f->path, tolerance);
}

static shb_status run_to_end(follower *f, bool *go_on, const char **end) {
  int most = f->residual->settings->max_points;
  while (*go_on && !*end) {
    if (f->response->branch[f->branch].n_points >= most) *end = "mhb.max_points reached";
    if (!*end) SHB_TRY(step(f, go_on, end));
  }
  return SHB_OK;
}

/* One way; and, unless that closed the curve or began on another one, the other way. */
static shb_status run_further(follower *f, const char **end, bool *none) {
  bool        go_on = true, found;
  const char *first = NULL;
  SHB_TRY(begin_further(f, 1, false, &found, &go_on));
  *none = !found;
  if (*none) return SHB_OK;
  SHB_TRY(run_to_end(f, &go_on, &first));
  *end = first;
  if (go_on && first != CLOSED && !f->start->along) {
    f->monitor->lock(f->monitor, true);
    mhb_response_reverse(f->response, f->branch);
    f->monitor->lock(f->monitor, false);
    mhb_closed_free(&f->closed);
    *end = NULL;
    SHB_TRY(begin_further(f, -1, true, &found, &go_on));
    if (found) SHB_TRY(run_to_end(f, &go_on, end));
    if (!found || !is_complete(first)) *end = first;
  }
  if (!go_on) *end = "interrupted";
  return SHB_OK;
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

static shb_status insert(mhb_judge_host *host, mhb_path_point *point, int special, int at) {
  follower *f = (follower *)host;
  mhb_harmonics_errors(f->harmonics, point);
  host->lock(host, true);
  shb_status status = mhb_record(f->response, f->branch, f->residual, point, special, 0);
  if (status == SHB_OK) mhb_response_place(f->response, f->branch, at);
  host->lock(host, false);
  return status;
}

static void lock_judge(mhb_judge_host *host, bool locked) {
  follower *f = (follower *)host;
  f->monitor->lock(f->monitor, locked);
}

static bool judged(mhb_judge_host *host, double value) {
  follower      *f     = (follower *)host;
  mhb_path_point point = {.value = value};
  return f->monitor->point(f->monitor, f->branch, &point);
}

/* Before the branch counts as complete: an interrupted run takes complete branches over as they are. */
static shb_status judge(follower *f, const char **reason) {
  bool finished = true;
  f->monitor->lock(f->monitor, true);
  drop_hairlines(&f->response->branch[f->branch],
                 mhb_parameter_shown(f->residual->parameter, f->path->high - f->path->low));
  if (!f->start) mhb_judge_by_folds(&f->response->branch[f->branch]); /* its beginning is stable */
  f->monitor->lock(f->monitor, false);
  if (f->residual->settings->stability == MHB_STABILITY_NEVER ||
      strcmp(*reason, "interrupted") == 0)
    return SHB_OK;
  f->harmonics->at = f->harmonics->highest; /* no point has more */
  use_rung(f);
  f->monitor->lock(f->monitor, true); /* FFTW's planner */
  shb_status made = mhb_judge_create(f->residual, &f->judge);
  f->monitor->lock(f->monitor, false);
  SHB_TRY(made);
  f->host           = (mhb_judge_host){.insert = insert, .lock = lock_judge, .point = judged};
  shb_status status = mhb_judge_branch(f->judge, f->path, f->response, f->branch, f->first,
                                       f->n_first, &f->host, &finished);
  if (!finished) *reason = "interrupted";
  return status;
}

static shb_status finish(follower *f, const char *reason) {
  char text[256];
  SHB_TRY(judge(f, &reason));
  snprintf(text, sizeof text, "%s", reason);
  if (f->gaps > 0)
    snprintf(text, sizeof text, "%s, with %d gap%s: %s", reason, f->gaps, f->gaps > 1 ? "s" : "",
             f->first_gap);
  shb_status status = SHB_OK;
  f->monitor->lock(f->monitor, true);
  mhb_branch *branch = &f->response->branch[f->branch];
  free(branch->reason);
  branch->reason   = strdup(text);
  branch->complete = is_complete(text);
  if (!branch->reason) status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  f->monitor->lock(f->monitor, false);
  return status;
}

/* What a branch needs, all made before the first point; on failure the caller destroys what is there. */
static shb_status create(follower *f) {
  size_t outputs = (size_t)f->n_outputs + 1;
  f->monitor->lock(f->monitor, true); /* FFTW's planner */
  shb_status status = mhb_harmonics_create(f->residual, &f->harmonics);
  f->monitor->lock(f->monitor, false);
  SHB_TRY(status);
  use_rung(f);
  f->before = calloc(outputs, sizeof(double));
  f->after  = calloc(outputs, sizeof(double));
  f->x      = calloc((size_t)mhb_harmonics_most_unknowns(f->harmonics), sizeof(double));
  SHB_CHECK(f->before && f->after && f->x, SHB_ERR_IO, "out of memory");
  return SHB_OK;
}

static void destroy(follower *f) {
  f->monitor->lock(f->monitor, true);
  mhb_judge_destroy(f->judge);
  mhb_harmonics_destroy(f->harmonics);
  f->monitor->lock(f->monitor, false);
  mhb_closed_free(&f->closed);
  free(f->before);
  free(f->after);
  free(f->x);
}

shb_status mhb_follow(mhb_residual *residual, mhb_response *response, int branch,
                      mhb_monitor *monitor) {
  const mhb_settings *s      = residual->settings;
  follower            f      = {.residual  = residual,
                                .response  = response,
                                .branch    = branch,
                                .monitor   = monitor,
                                .n_outputs = mhb_outputs(residual),
                                .clock     = shb_seconds(),
                                .farthest  = mhb_parameter_end(s, residual->parameter, 0)};
  shb_status          status = create(&f);
  if (status == SHB_OK) {
    const char *why = run(&f, s->max_points, &status);
    if (status == SHB_OK) status = finish(&f, why);
  }
  destroy(&f);
  return status;
}

shb_status mhb_follow_from(mhb_residual *residual, mhb_response *response, int branch,
                           mhb_monitor *monitor, const mhb_start *start, bool *none) {
  follower   f      = {.residual  = residual,
                       .response  = response,
                       .branch    = branch,
                       .monitor   = monitor,
                       .n_outputs = mhb_outputs(residual),
                       .clock     = shb_seconds(),
                       .start     = start};
  shb_status status = create(&f);
  *none             = false;
  if (status == SHB_OK) {
    const char *why = NULL;
    f.home          = f.harmonics->at;
    status          = run_further(&f, &why, none);
    if (status == SHB_OK && !*none) status = finish(&f, why);
  }
  destroy(&f);
  return status;
}
