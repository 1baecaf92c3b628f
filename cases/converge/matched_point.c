#include "cases/converge/matched_point.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/branches/branch_stability.h"
#include "mhb/branches/record.h"
#include "mhb/continuation/nearest_solution.h"
#include "mhb/numerics/fourier.h"
#include "mhb/numerics/vector.h"
#include "mhb/tracking/output_amplitude.h"

/* Of the residual, relative to the motion. */
static const double TOLERANCE = 1e-10;

struct point_matcher {
  mhb_settings    settings;
  mhb_balance    *balance;
  mhb_newton     *newton;
  post_output     output;
  double         *x, *normal;   /* [n], [n+1] */
  double          omega;        /* rad/s, of the solution in x */
  double         *last, *start; /* [n+1] the solution found last, and what it was searched from */
  bool            has_last;
  double          tolerance;      /* of the residual */
  double complex *force, *motion; /* [3 pairs], [3 probes] of one harmonic */
};

static shb_status make(const modal_model *model, point_matcher *matcher) {
  SHB_TRY(mhb_balance_create(model, &matcher->settings, &matcher->balance));
  size_t n        = (size_t)matcher->balance->n;
  matcher->x      = calloc(n, sizeof *matcher->x);
  matcher->normal = calloc(n + 1, sizeof *matcher->normal);
  matcher->last   = calloc(n + 1, sizeof *matcher->last);
  matcher->start  = calloc(n + 1, sizeof *matcher->start);
  matcher->force  = calloc(3 * (size_t)model->n_pairs, sizeof *matcher->force);
  matcher->motion = calloc(3 * (size_t)model->n_probes + 1, sizeof *matcher->motion);
  bool good       = matcher->x && matcher->normal && matcher->force && matcher->motion;
  SHB_CHECK(good && matcher->last && matcher->start, SHB_ERR_IO, "out of memory");
  matcher->newton = mhb_newton_create(matcher->balance->n);
  /* short memory is told here; later it would pass for a place without a solution */
  mhb_newton_bind(matcher->newton, matcher->balance);
  return SHB_OK;
}

shb_status point_matcher_create(const modal_model *model, const mhb_settings *settings,
                                int harmonics, post_output output, point_matcher **out) {
  point_matcher *matcher = calloc(1, sizeof *matcher);
  SHB_CHECK(matcher, SHB_ERR_IO, "out of memory");
  matcher->settings                  = *settings;
  matcher->settings.harmonics        = harmonics;
  matcher->settings.motion_tolerance = 0;
  matcher->output                    = output;
  matcher->tolerance                 = TOLERANCE;
  shb_status status                  = make(model, matcher);
  if (status == SHB_OK) *out = matcher;
  if (status != SHB_OK) point_matcher_destroy(matcher);
  return status;
}

void point_matcher_destroy(point_matcher *matcher) {
  if (!matcher) return;
  mhb_newton_destroy(matcher->newton);
  mhb_balance_destroy(matcher->balance);
  free(matcher->x);
  free(matcher->normal);
  free(matcher->last);
  free(matcher->start);
  free(matcher->force);
  free(matcher->motion);
  free(matcher);
}

/* Adds factor times the motion of a point, truncated or padded to the harmonics of the balance. */
static void add_motion(const point_matcher *matcher, const curve_place *place, int point,
                       double factor, double *to) {
  const mhb_balance    *b = matcher->balance;
  int                   K = place->branch->n_harmonics, rows = 3 * b->n_pairs;
  const double complex *u = place->branch->motion + (size_t)point * (size_t)rows * (size_t)(K + 1);
  for (int row = 0; row < rows; row++)
    for (int k = 0; k <= K && k <= b->m; k++) {
      double complex a  = u[row * (K + 1) + k];
      double        *at = to + (size_t)row * (size_t)b->nb + (k > 0 ? 2 * k - 1 : 0);
      at[0] += factor * creal(a);
      if (k > 0) at[1] += factor * cimag(a);
    }
}

/* Amplitude at the solution at which the balance was evaluated last. */
static double amplitude(const point_matcher *matcher) {
  const mhb_balance *b = matcher->balance;
  int k = matcher->settings.subharmonics <= b->m ? matcher->settings.subharmonics : b->m;
  if (matcher->output.place == POST_PLACE_PROBE) {
    mhb_balance_contact_force(b, k, matcher->force);
    mhb_receptance_probe(b->receptance, k, matcher->force, matcher->motion);
    return post_semi_major_axis(3, matcher->motion + 3 * (size_t)matcher->output.index, 1);
  }
  double complex u[3];
  for (int c = 0; c < 3; c++) {
    const double *a =
        matcher->x + (size_t)(3 * matcher->output.index + c) * (size_t)b->nb + (2 * k - 1);
    u[c] = CMPLX(a[0], a[1]);
  }
  return post_semi_major_axis(3, u, 1);
}

void point_matcher_set_tolerance(point_matcher *matcher, double tolerance) {
  matcher->tolerance = tolerance;
}

/* The width of the frequency range, rad/s. */
static double span_of(const point_matcher *matcher) {
  const double *range = matcher->settings.frequency;
  return SHB_TWO_PI * (range[1] - range[0]);
}

/* x <- the motion at a place of the curve; returns its frequency, rad/s. */
static double set_start(point_matcher *matcher, const curve_place *place) {
  const double *f = place->branch->frequency;
  memset(matcher->x, 0, (size_t)matcher->balance->n * sizeof *matcher->x);
  add_motion(matcher, place, place->from, 1 - place->part, matcher->x);
  add_motion(matcher, place, place->to, place->part, matcher->x);
  mhb_balance_set_preload(matcher->balance, place->branch->n0[place->from]);
  return SHB_TWO_PI * ((1 - place->part) * f[place->from] + place->part * f[place->to]);
}

/* place NULL: at the same frequency */
static void set_normal(point_matcher *matcher, const curve_place *place) {
  size_t n = (size_t)matcher->balance->n;
  memset(matcher->normal, 0, (n + 1) * sizeof *matcher->normal);
  if (place) {
    const double *f = place->branch->frequency;
    add_motion(matcher, place, place->low, -1, matcher->normal);
    add_motion(matcher, place, place->high, 1, matcher->normal);
    matcher->normal[n] = SHB_TWO_PI * (f[place->high] - f[place->low]);
  } else {
    matcher->normal[n] = span_of(matcher);
  }
}

/* Newton's method from x and omega, in units of scale. */
static int solve_from(point_matcher *matcher, double omega, double scale, double found[2]) {
  mhb_balance *b = matcher->balance;
  if (!(scale > 0) ||
      !mhb_nearest_solution(matcher->newton, b, matcher->normal, scale, span_of(matcher),
                            matcher->tolerance, matcher->x, &omega))
    return 0;
  size_t n          = (size_t)b->n;
  matcher->omega    = omega;
  matcher->has_last = true;
  memcpy(matcher->last, matcher->x, n * sizeof *matcher->last);
  matcher->last[n] = omega;
  found[0]         = omega / SHB_TWO_PI;
  found[1]         = amplitude(matcher);
  return 1;
}

int point_matcher_solve(point_matcher *matcher, const curve_place *place, bool same_frequency,
                        double found[2]) {
  double omega = set_start(matcher, place);
  size_t n     = (size_t)matcher->balance->n;
  set_normal(matcher, same_frequency ? NULL : place);
  memcpy(matcher->start, matcher->x, n * sizeof *matcher->start);
  matcher->start[n] = omega;
  return solve_from(matcher, omega, mhb_norm(matcher->x, matcher->balance->n), found);
}

int point_matcher_follow(point_matcher *matcher, const curve_place *place, double found[2]) {
  if (!matcher->has_last) return point_matcher_solve(matcher, place, false, found);
  size_t n     = (size_t)matcher->balance->n;
  double omega = set_start(matcher, place), moved = omega - matcher->start[n];
  double scale      = mhb_norm(matcher->x, matcher->balance->n);
  matcher->start[n] = omega;
  for (size_t i = 0; i < n; i++) {
    double here = matcher->x[i];
    matcher->x[i] += matcher->last[i] - matcher->start[i];
    matcher->start[i] = here;
  }
  matcher->has_last = false; /* unless one is found */
  set_normal(matcher, place);
  return solve_from(matcher, matcher->last[n] + moved, scale, found);
}

shb_status point_matcher_keep(const point_matcher *matcher, matched_solution *s) {
  const mhb_balance *b    = matcher->balance;
  size_t             size = (size_t)b->n * sizeof *s->x;
  double            *x    = realloc(s->x, size);
  SHB_CHECK(x, SHB_ERR_IO, "out of memory");
  *s = (matched_solution){b->m, matcher->last[b->n], b->eval->at.n0, x};
  memcpy(x, matcher->last, size);
  return SHB_OK;
}

void matched_solution_free(matched_solution *s) {
  free(s->x);
  *s = (matched_solution){0};
}

/* Adds factor times a kept solution, truncated or padded, and its frequency; to[n+1]. */
static void add_kept(const point_matcher *matcher, const matched_solution *s, double factor,
                     double *to) {
  const mhb_balance *b     = matcher->balance;
  int                least = s->harmonics < b->m ? s->harmonics : b->m;
  int                other = mhb_real_size(s->harmonics), own = mhb_real_size(least);
  for (int row = 0; row < 3 * b->n_pairs; row++)
    for (int i = 0; i < own; i++)
      to[(size_t)row * (size_t)b->nb + (size_t)i] +=
          factor * s->x[(size_t)row * (size_t)other + (size_t)i];
  to[b->n] += factor * s->omega;
}

int point_matcher_between(point_matcher *matcher, const matched_solution *a,
                          const matched_solution *b, double share,
                          const matched_solution *const chord[2], double found[2]) {
  size_t n = (size_t)matcher->balance->n;
  memset(matcher->start, 0, (n + 1) * sizeof *matcher->start);
  memset(matcher->normal, 0, (n + 1) * sizeof *matcher->normal);
  add_kept(matcher, a, 1 - share, matcher->start);
  add_kept(matcher, b, share, matcher->start);
  add_kept(matcher, chord[0], -1, matcher->normal);
  add_kept(matcher, chord[1], 1, matcher->normal);
  memcpy(matcher->x, matcher->start, n * sizeof *matcher->x);
  mhb_balance_set_preload(matcher->balance, a->n0);
  return solve_from(matcher, matcher->start[n], mhb_norm(matcher->x, matcher->balance->n), found);
}

/* The output as mhb/tracking numbers it: probes, then pairs. */
static int tracked_output(const point_matcher *matcher) {
  const bool probe = matcher->output.place == POST_PLACE_PROBE;
  return matcher->output.index + (probe ? 0 : matcher->balance->receptance->model->n_probes);
}

/* x <- x - J^-1 r, J factored, r the residual of Newton's workspace. Returns the change of the
 * amplitude, m; NAN: none. */
static double chord_step(point_matcher *matcher, const double *by_x) {
  mhb_newton *w = matcher->newton;
  const int   n = matcher->balance->n;
  if (!mhb_condensation_solve(w->system, w->r)) return NAN;
  for (int i = 0; i < n; i++) matcher->x[i] -= w->r[i];
  return -mhb_dot(n, by_x, w->r);
}

shb_status point_matcher_change(point_matcher *matcher, const matched_solution *s, double *change) {
  mhb_balance    *b      = matcher->balance;
  mhb_newton     *newton = matcher->newton;
  double complex *weight = calloc(mhb_amplitude_weights(b), sizeof *weight);
  mhb_amplitude   size   = {.by_x = matcher->normal, .weight = weight, .size = MHB_SIZE_HALF_AXIS};
  SHB_CHECK(weight, SHB_ERR_IO, "out of memory");
  memset(matcher->start, 0, ((size_t)b->n + 1) * sizeof *matcher->start);
  add_kept(matcher, s, 1, matcher->start);
  memcpy(matcher->x, matcher->start, (size_t)b->n * sizeof *matcher->x);
  matcher->has_last = false;
  mhb_balance_set_preload(b, s->n0);
  mhb_balance_linearise(b, matcher->x, s->omega, newton->r, NULL);
  mhb_output_amplitude(b, matcher->x, tracked_output(matcher), &size);
  *change = NAN;
  if (mhb_condensation_factor(newton->system, NULL, NULL)) {
    const double first = chord_step(matcher, size.by_x);
    mhb_balance_evaluate(b, matcher->x, s->omega, newton->r, NULL, NULL);
    *change = fabs(first) + fabs(chord_step(matcher, size.by_x));
  }
  free(weight);
  return SHB_OK;
}

shb_status point_matcher_record(point_matcher *matcher, mhb_response *response, int branch) {
  mhb_curve_point point = {
      .x = matcher->x, .value = matcher->omega, .evaluation = matcher->balance->eval};
  mhb_record(response, branch, matcher->balance, &point, MHB_PEAK, 0);
  return SHB_OK;
}

shb_status point_matcher_judge(point_matcher *matcher, int *stable) {
  mhb_multipliers multipliers;
  mhb_floquet    *floquet    = NULL;
  mhb_truncation *truncation = NULL;
  shb_status      status     = mhb_truncation_create(matcher->balance, &truncation);
  if (status == SHB_OK) status = mhb_branch_floquet_create(matcher->balance, &floquet);
  if (status == SHB_OK) {
    const mhb_judged_point at = {matcher->x, matcher->omega, INFINITY};
    mhb_branch_floquet_judge(floquet, matcher->balance, truncation, &at, &multipliers);
    *stable = multipliers.verdict == MHB_UNSTABLE ? 0 : multipliers.verdict == MHB_STABLE ? 1 : -1;
  }
  mhb_floquet_destroy(floquet);
  mhb_truncation_destroy(truncation);
  return status;
}

shb_status point_matcher_peak(point_matcher *matcher, mhb_peak_near near,
                              mhb_peak_derivatives *derivatives, double found[2]) {
  mhb_balance *b = matcher->balance;
  found[1]       = amplitude(matcher);
  SHB_TRY(mhb_peak_derivatives_find(b, tracked_output(matcher), MHB_SIZE_HALF_AXIS, near,
                                    matcher->x, matcher->omega, found[1], derivatives));
  found[0] = derivatives->omega / SHB_TWO_PI;
  found[1] = derivatives->amplitude;
  if (derivatives->kind != MHB_PEAK_SMOOTH) return SHB_OK;
  set_normal(matcher, NULL);
  if (!solve_from(matcher, derivatives->omega, mhb_norm(matcher->x, b->n), found))
    derivatives->kind = MHB_PEAK_UNJUDGED;
  return SHB_OK;
}
