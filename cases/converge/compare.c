#include "cases/converge/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/converge/matched_point.h"
#include "mesh/base/progress.h"
#include "mhb/branches/harmonic_selection.h"
#include "postproc/analysis/curve_distance.h"

static const double FAR =
    2e-3; /* distance above which the polyline is compared too: its own error is of this size */
static const double SAGS = 4;

enum { MOST_HARMONICS = 256 };

/* One of the two curves compared. */
typedef struct {
  mhb_response     *response;
  const mhb_branch *branch;
  double           *amplitude;
  post_polyline     line;
} side;

typedef struct {
  const modal_model  *model;
  const mhb_settings *settings;
  post_output         output;
  point_matcher      *matcher[MOST_HARMONICS]; /* by number of harmonics, created at first use */
  side                rung, reference;
  double              unit; /* m */
  rung_error         *error;
} comparison;

static shb_status load_curves(const char *stem, side *s) {
  char      *path   = rung_response(stem);
  shb_status status = mhb_response_read(path, &s->response);
  free(path);
  return status;
}

static shb_status choose(post_output output, int b, side *s) {
  s->branch = &s->response->branch[b];
  free(s->amplitude);
  s->amplitude = NULL;
  SHB_TRY(post_series(s->response, s->branch, output, POST_QUANTITY_FIRST_HARMONIC, &s->amplitude));
  s->line = (post_polyline){s->branch->n_points, s->branch->frequency, s->amplitude};
  return SHB_OK;
}

static shb_status matcher_of(comparison *c, int harmonics, point_matcher **out) {
  SHB_CHECK(harmonics >= 1 && harmonics < MOST_HARMONICS, SHB_ERR_INPUT,
            "the response has a point of %d harmonics; 1 to %d are wanted", harmonics,
            MOST_HARMONICS - 1);
  if (!c->matcher[harmonics])
    SHB_TRY(
        point_matcher_create(c->model, c->settings, harmonics, c->output, &c->matcher[harmonics]));
  *out = c->matcher[harmonics];
  return SHB_OK;
}

/* Distance from point i of the reference to the curve of the rung. */
static shb_status from_reference(comparison *c, int i, double *distance) {
  const side *r    = &c->reference;
  int         last = r->branch->n_points - 1, near = 0;
  double      point[2] = {r->branch->frequency[i], r->amplitude[i]}, found[2];
  double      drawn    = post_curve_distance(point, &c->rung.line, c->unit, &near);
  curve_place place    = {r->branch, i, i, i > 0 ? i - 1 : 0, i < last ? i + 1 : last, 0};
  *distance            = INFINITY;
  c->error->n++;
  if (r->response->n_pairs == c->rung.response->n_pairs) {
    point_matcher *matcher = NULL;
    SHB_TRY(matcher_of(c, c->rung.branch->harmonics[near], &matcher));
    if (point_matcher_solve(matcher, &place, i == 0 || i == last, found))
      *distance = post_point_distance(point, found, c->unit);
  }
  c->error->lost += !isfinite(*distance);
  if (*distance > FAR) *distance = fmin(*distance, drawn);
  return SHB_OK;
}

/* Distance from point i of the rung to the reference curve. */
static double from_rung(const comparison *c, int i) {
  const side *s        = &c->rung;
  double      point[2] = {s->branch->frequency[i], s->amplitude[i]};
  int         near     = 0;
  double      d        = post_curve_distance(point, &c->reference.line, c->unit, &near);
  double      sag      = fmax(post_chord_deviation(&c->reference.line, near, c->unit),
                    near > 0 ? post_chord_deviation(&c->reference.line, near - 1, c->unit) : 0);
  return d > fmax(FAR, SAGS * sag) ? d : 0;
}

/* Add the distance of branch b of the rung from branch d of the reference to the error. */
static shb_status compare_branches(comparison *c, int b, int d) {
  double distance;
  SHB_TRY(choose(c->output, b, &c->rung));
  SHB_TRY(choose(c->output, d, &c->reference));
  c->unit = 0;
  for (int i = 0; i < c->reference.line.n; i++) c->unit = fmax(c->unit, c->reference.amplitude[i]);
  SHB_CHECK(c->unit > 0 && c->rung.line.n > 0, SHB_ERR_INPUT,
            "curve %d (from 0) has no motion: nothing to compare", b);
  for (int i = 0; i < c->reference.line.n; i++) {
    SHB_TRY(from_reference(c, i, &distance));
    c->error->curve = fmax(c->error->curve, distance);
    SHB_CHECK(!shb_interrupted(), SHB_INTERRUPTED, "interrupted");
  }
  for (int i = 0; i < c->rung.line.n; i++) c->error->curve = fmax(c->error->curve, from_rung(c, i));
  return SHB_OK;
}

static bool is_secondary(const mhb_response *response, int b) {
  const mhb_branch *branch = &response->branch[b];
  return branch->kind == MHB_BRANCH_NONLINEAR && branch->main != b && branch->n_points > 0;
}

/* A secondary branch, b of one of the sides, counts with its distance from the nearest branch of
 * the same preload on the other side. */
static shb_status compare_secondary(comparison *c, int b, bool of_rung) {
  const mhb_response *own   = of_rung ? c->rung.response : c->reference.response;
  const mhb_response *other = of_rung ? c->reference.response : c->rung.response;
  rung_error         *all = c->error, nearest = {.curve = INFINITY};
  shb_status          status = SHB_OK;
  for (int d = 0; d < other->n_branches && status == SHB_OK; d++) {
    if (other->branch[d].main != own->branch[b].main) continue;
    if (d != own->branch[b].main && !is_secondary(other, d)) continue;
    rung_error error = {0};
    c->error         = &error;
    status           = compare_branches(c, of_rung ? b : d, of_rung ? d : b);
    if (error.curve < nearest.curve) nearest = error;
  }
  c->error   = all;
  all->curve = fmax(all->curve, nearest.curve);
  all->n += nearest.n;
  all->lost += nearest.lost;
  return status;
}

static int main_branches(const mhb_response *response) {
  int n = 0;
  for (int b = 0; b < response->n_branches; b++)
    n += response->branch[b].kind == MHB_BRANCH_NONLINEAR && response->branch[b].main == b;
  return n;
}

/* The motion of all curves becomes that of the patches: the mean over their pairs. */
static shb_status join_motion(const modal_joining *j, mhb_response *response) {
  for (int i = 0; i < response->n_branches; i++) {
    mhb_branch     *b = &response->branch[i];
    const size_t    K = (size_t)b->n_harmonics + 1, from = 3 * (size_t)j->n_pairs * K;
    const size_t    to   = 3 * (size_t)j->n_patches * K;
    double complex *mean = calloc(to + 1, sizeof *mean);
    SHB_CHECK(mean, SHB_ERR_IO, "out of memory");
    for (size_t p = 0; p < (size_t)b->n_points; p++) { /* in place: patches are fewer */
      const double complex *x = b->motion + p * from;
      memset(mean, 0, to * sizeof *mean);
      for (size_t row = 0; row < 3 * (size_t)j->n_pairs; row++) {
        double complex *at = mean + (3 * (size_t)j->patch[row / 3] + row % 3) * K;
        for (size_t k = 0; k < K; k++) at[k] += j->weight[row / 3] * x[row * K + k];
      }
      memcpy(b->motion + p * to, mean, to * sizeof *mean);
    }
    free(mean);
  }
  response->n_pairs = j->n_patches;
  return SHB_OK;
}

static shb_status compare_all(comparison *c, const modal_joining *joining, const char *stem,
                              const char *reference) {
  SHB_TRY(load_curves(stem, &c->rung));
  SHB_TRY(load_curves(reference, &c->reference));
  const mhb_response *rung = c->rung.response, *finer = c->reference.response;
  if (joining && rung->n_pairs == joining->n_patches && finer->n_pairs == joining->n_pairs)
    SHB_TRY(join_motion(joining, c->reference.response));
  SHB_CHECK(main_branches(rung) == main_branches(finer), SHB_ERR_INPUT,
            "%s and %s hold different preloads", stem, reference);
  for (int b = 0; b < finer->n_branches; b++) {
    if (is_secondary(finer, b)) SHB_TRY(compare_secondary(c, b, false));
    if (finer->branch[b].kind == MHB_BRANCH_NONLINEAR && finer->branch[b].main == b)
      SHB_TRY(compare_branches(c, b, b));
  }
  for (int b = 0; b < rung->n_branches; b++)
    if (is_secondary(rung, b)) SHB_TRY(compare_secondary(c, b, true));
  return SHB_OK;
}

/* ---------------------------------------------------------------- points of time integration */

/* Error at point i by time integration, whose preload is that of the rung's curve. */
static shb_status from_integration(comparison *c, int i) {
  const side    *r        = &c->reference;
  double         point[2] = {r->branch->frequency[i], r->amplitude[i]}, found[2];
  curve_place    place    = {r->branch, i, i, i, i, 0};
  int            near     = 0;
  double         drawn    = post_curve_distance(point, &c->rung.line, c->unit, &near);
  point_matcher *matcher  = NULL;
  SHB_TRY(matcher_of(c, c->rung.branch->harmonics[near], &matcher));
  bool solved = point_matcher_solve(matcher, &place, true, found);
  c->error->n++;
  c->error->lost += !solved;
  c->error->curve = fmax(c->error->curve, solved ? fabs(found[1] - point[1]) / c->unit : drawn);
  return SHB_OK;
}

/* Index of the rung's main curve of a preload; -1 if there is none. */
static int curve_of(const mhb_response *response, double n0) {
  for (int b = 0; b < response->n_branches; b++) {
    const mhb_branch *branch = &response->branch[b];
    if (branch->kind != MHB_BRANCH_NONLINEAR || branch->n_points == 0) continue;
    if (fabs(branch->n0[0] - n0) <= 1e-9 * fmax(fabs(n0), 1e-300)) return b;
  }
  return -1;
}

static shb_status compare_points(comparison *c, int b) {
  const mhb_branch *points = &c->reference.response->branch[b];
  int               own    = points->n_points > 0 ? curve_of(c->rung.response, points->n0[0]) : -1;
  if (points->kind != MHB_BRANCH_INTEGRATION || own < 0) return SHB_OK;
  SHB_TRY(choose(c->output, own, &c->rung));
  SHB_TRY(choose(c->output, b, &c->reference));
  c->unit = 0;
  for (int i = 0; i < c->rung.line.n; i++) c->unit = fmax(c->unit, c->rung.amplitude[i]);
  for (int i = 0; c->unit > 0 && i < points->n_points; i++)
    if (points->multiple[i] == 1) SHB_TRY(from_integration(c, i));
  return SHB_OK;
}

static shb_status compare_all_points(comparison *c, const char *stem, const char *path) {
  SHB_TRY(load_curves(stem, &c->rung));
  SHB_TRY(mhb_response_read(path, &c->reference.response));
  const mhb_response *r = c->reference.response, *own = c->rung.response;
  SHB_CHECK(r->n_pairs == own->n_pairs && r->n_probes == own->n_probes, SHB_ERR_INPUT,
            "%s: holds %d contacts and %d probes, the case %d and %d", path, r->n_pairs,
            r->n_probes, own->n_pairs, own->n_probes);
  for (int b = 0; b < r->n_branches; b++) SHB_TRY(compare_points(c, b));
  return SHB_OK;
}

/* ---------------------------------------------------------------- both */

static void end(comparison *c) {
  for (int i = 0; i < MOST_HARMONICS; i++) point_matcher_destroy(c->matcher[i]);
  side *both[] = {&c->rung, &c->reference};
  for (int i = 0; i < 2; i++) {
    free(both[i]->amplitude);
    mhb_response_destroy(both[i]->response);
  }
}

shb_status compare_rungs(const case_model *source, post_output output, const char *stem,
                         const char *reference, rung_error *error) {
  *error       = (rung_error){0};
  comparison c = {
      .model = &source->model, .settings = &source->settings, .output = output, .error = error};
  const modal_joining *joining = source->points ? &source->points->joining : NULL;
  shb_status           status  = compare_all(&c, joining, stem, reference);
  end(&c);
  return status;
}

shb_status compare_integration(const modal_model *model, const mhb_settings *settings,
                               post_output output, const char *stem, const char *path,
                               rung_error *error) {
  *error            = (rung_error){0};
  comparison c      = {.model = model, .settings = settings, .output = output, .error = error};
  shb_status status = compare_all_points(&c, stem, path);
  end(&c);
  return status;
}
