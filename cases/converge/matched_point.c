#include "cases/converge/matched_point.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/branches/record.h"
#include "mhb/continuation/nearest_solution.h"
#include "mhb/floquet/floquet.h"

struct point_matcher {
  mhb_settings    settings;
  mhb_balance    *balance;
  mhb_newton     *newton;
  post_output     output;
  double         *x, *normal;     /* [n], [n+1] */
  double          omega;          /* rad/s, of the solution in x */
  double complex *force, *motion; /* [3 pairs], [3 probes] of one harmonic */
};

static shb_status make(const modal_model *model, point_matcher *matcher) {
  SHB_TRY(mhb_balance_create(model, &matcher->settings, &matcher->balance));
  size_t n        = (size_t)matcher->balance->n;
  matcher->x      = calloc(n, sizeof *matcher->x);
  matcher->normal = calloc(n + 1, sizeof *matcher->normal);
  matcher->force  = calloc(3 * (size_t)model->n_pairs, sizeof *matcher->force);
  matcher->motion = calloc(3 * (size_t)model->n_probes + 1, sizeof *matcher->motion);
  SHB_CHECK(matcher->x && matcher->normal && matcher->force && matcher->motion, SHB_ERR_IO,
            "out of memory");
  return mhb_newton_create(matcher->balance->n, &matcher->newton);
}

shb_status point_matcher_create(const modal_model *model, const mhb_settings *settings,
                                int harmonics, post_output output, point_matcher **out) {
  point_matcher *matcher = calloc(1, sizeof *matcher);
  SHB_CHECK(matcher, SHB_ERR_IO, "out of memory");
  matcher->settings                  = *settings;
  matcher->settings.harmonics        = harmonics;
  matcher->settings.motion_tolerance = 0;
  matcher->output                    = output;
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

int point_matcher_solve(point_matcher *matcher, const curve_place *place, bool same_frequency,
                        double found[2]) {
  const mhb_settings *s    = &matcher->settings;
  mhb_balance        *b    = matcher->balance;
  const double       *f    = place->branch->frequency;
  size_t              n    = (size_t)b->n;
  double              span = SHB_TWO_PI * (s->frequency[1] - s->frequency[0]);
  memset(matcher->x, 0, n * sizeof *matcher->x);
  memset(matcher->normal, 0, (n + 1) * sizeof *matcher->normal);
  add_motion(matcher, place, place->from, 1 - place->part, matcher->x);
  add_motion(matcher, place, place->to, place->part, matcher->x);
  if (!same_frequency) {
    add_motion(matcher, place, place->low, -1, matcher->normal);
    add_motion(matcher, place, place->high, 1, matcher->normal);
  }
  matcher->normal[n] = same_frequency ? span : SHB_TWO_PI * (f[place->high] - f[place->low]);
  double omega = SHB_TWO_PI * ((1 - place->part) * f[place->from] + place->part * f[place->to]);
  double scale = mhb_norm(matcher->x, b->n);
  mhb_balance_set_preload(b, place->branch->n0[place->from]);
  if (!(scale > 0) ||
      !mhb_nearest_solution(matcher->newton, b, matcher->normal, scale, span, matcher->x, &omega))
    return 0;
  matcher->omega = omega;
  found[0]       = omega / SHB_TWO_PI;
  found[1]       = amplitude(matcher);
  return 1;
}

shb_status point_matcher_record(point_matcher *matcher, mhb_response *response, int branch) {
  mhb_curve_point point = {
      .x = matcher->x, .value = matcher->omega, .evaluation = matcher->balance->eval};
  return mhb_record(response, branch, matcher->balance, &point, MHB_PEAK, 0);
}

shb_status point_matcher_judge(point_matcher *matcher, int *stable) {
  enum { SUBSTEPS = 128, MAX_STATES = 600 }; /* as of curves with many states (branch_stability) */
  const mhb_balance    *b        = matcher->balance;
  const mhb_evaluation *e        = b->eval;
  mhb_solution          solution = {e->at.omega, b->law, e->info, matcher->x, e->p};
  mhb_floquet          *floquet  = NULL;
  mhb_multipliers       multipliers;
  SHB_TRY(mhb_floquet_create(b->receptance, &matcher->settings, SUBSTEPS, MAX_STATES, &floquet));
  mhb_floquet_evaluate(floquet, &solution, &multipliers);
  *stable = multipliers.verdict == MHB_UNSTABLE ? 0 : multipliers.verdict == MHB_STABLE ? 1 : -1;
  mhb_floquet_destroy(floquet);
  return SHB_OK;
}

shb_status point_matcher_derivatives(point_matcher *matcher, mhb_peak_derivatives *derivatives) {
  mhb_balance *b     = matcher->balance;
  bool         probe = matcher->output.place == POST_PLACE_PROBE;
  int          index = matcher->output.index + (probe ? 0 : b->receptance->model->n_probes);
  return mhb_peak_derivatives_find(b, index, MHB_SIZE_HALF_AXIS, matcher->x, matcher->omega,
                                   amplitude(matcher), derivatives);
}
