#include "mhb/follow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/progress.h"
#include "mhb/record.h"

static const double PI = 3.14159265358979323846;

/* A branch under way. */
typedef struct {
  mhb_residual *residual;
  mhb_path     *path;
  mhb_response *response;
  int           branch;
  mhb_monitor  *monitor;
  int           n_outputs;
  double       *before, *after; /* [outputs] slopes of the amplitudes at now and next */
  double        clock;
} follower;

static double fold_indicator(const mhb_path *path, const mhb_path_point *point, void *context) {
  (void)context;
  return point->tangent[path->n];
}

static double peak_indicator(const mhb_path *path, const mhb_path_point *point, void *context) {
  return mhb_output_slope(path, point, *(const int *)context);
}

/* Record a point; false: stop. */
static shb_status record(follower *f, mhb_path_point *point, int special, bool *go_on) {
  mhb_residual_errors(f->residual, point->x, point->omega, &point->truncation, &point->modal);
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
    SHB_TRY(record(f, &f->path->probe, list[i].special, go_on));
  }
  return SHB_OK;
}

/* Leave the residual's workspace at a point that was corrected earlier. */
static void revisit(follower *f, const mhb_path_point *point) {
  mhb_newton *w = f->path->newton;
  mhb_residual_evaluate(f->residual, point->x, point->omega, w->r, w->jacobian, NULL);
}

static const char *run(follower *f, int max_points, shb_status *status) {
  mhb_path *path  = f->path;
  bool      go_on = true;
  revisit(f, &path->now);
  slopes(f, &path->now, f->before);
  *status = record(f, &path->now, MHB_ORDINARY, &go_on);
  while (*status == SHB_OK && go_on) {
    if (f->response->branch[f->branch].n_points >= max_points) return "mhb.max_points reached";
    mhb_path_outcome outcome = mhb_path_step(path);
    if (outcome == MHB_PATH_STALLED) return "no step converged";
    revisit(f, &path->next);
    slopes(f, &path->next, f->after);
    *status = record_events(f, &go_on);
    if (*status != SHB_OK || !go_on) break;
    revisit(f, &path->next);
    *status = record(f, &path->next, MHB_ORDINARY, &go_on);
    if (outcome == MHB_PATH_AT_END) return "end of range";
    if (outcome == MHB_PATH_AT_START) return "turned back to the start of the range";
    mhb_path_advance(path);
    double *swap = f->before;
    f->before    = f->after;
    f->after     = swap;
  }
  return "interrupted";
}

/* A pair of folds that spans less than 1e-5 of the frequency is no jump that anyone could observe: not marked. */
static void drop_hairlines(mhb_branch *branch) {
  int last = -1;
  for (int i = 0; i < branch->n_points; i++) {
    if (branch->special[i] != MHB_FOLD) continue;
    double width = last < 0 ? INFINITY : fabs(branch->frequency[i] - branch->frequency[last]);
    if (width < 1e-5 * branch->frequency[i]) {
      branch->special[i] = branch->special[last] = MHB_ORDINARY;
      last                                       = -1;
    } else {
      last = i;
    }
  }
}

/* Which parts of the branch are stable by the parity of folds passed: exact for fold bifurcations, blind to others. */
static void mark_stability(mhb_branch *branch) {
  int stable = 1;
  for (int i = 0; i < branch->n_points; i++) {
    branch->stable[i] = stable;
    if (branch->special[i] == MHB_FOLD) stable = !stable;
  }
}

static shb_status finish(follower *f, const char *reason) {
  shb_status status = SHB_OK;
  f->monitor->lock(f->monitor, true);
  mhb_branch *branch = &f->response->branch[f->branch];
  free(branch->reason);
  branch->reason   = strdup(reason);
  branch->complete = strcmp(reason, "end of range") == 0;
  drop_hairlines(branch);
  mark_stability(branch);
  if (!branch->reason) status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  f->monitor->lock(f->monitor, false);
  return status;
}

static shb_status follow_from(follower *f, double *x) {
  const mhb_settings *s   = f->residual->settings;
  double              low = 2 * PI * s->frequency[0];
  int                 iterations;
  mhb_reason          reason =
      mhb_first_solution(f->path->newton, f->residual, low, f->path->tolerance, x, &iterations);
  if (reason == MHB_CONVERGED) reason = mhb_path_start(f->path, x, low, 1);
  if (reason != MHB_CONVERGED) {
    char text[128];
    snprintf(text, sizeof text, "no first solution at %g Hz: %s", s->frequency[0],
             mhb_reason_text(reason));
    return finish(f, text);
  }
  shb_status  status;
  const char *why = run(f, s->max_points, &status);
  SHB_TRY(status);
  return finish(f, why);
}

shb_status mhb_follow(mhb_residual *residual, mhb_response *response, int branch,
                      mhb_monitor *monitor) {
  const mhb_settings *s = residual->settings;
  follower            f = {.residual  = residual,
                           .response  = response,
                           .branch    = branch,
                           .monitor   = monitor,
                           .n_outputs = mhb_outputs(residual),
                           .clock     = shb_seconds()};
  SHB_TRY(mhb_path_create(residual, 2 * PI * s->frequency[0], 2 * PI * s->frequency[1], &f.path));
  size_t outputs    = (size_t)f.n_outputs + 1;
  f.before          = calloc(outputs, sizeof(double));
  f.after           = calloc(outputs, sizeof(double));
  double    *x      = calloc((size_t)residual->n, sizeof(double));
  shb_status status = f.before && f.after && x ? follow_from(&f, x) : SHB_ERR_IO;
  free(f.before);
  free(f.after);
  free(x);
  mhb_path_destroy(f.path);
  return status;
}
