#include "cases/converge/matched_point.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/continuation/nearest_solution.h"

struct witness {
  mhb_settings    settings;
  mhb_balance    *residual;
  mhb_newton     *newton;
  post_output     output;
  double         *x, *normal;     /* [n], [n+1] */
  double complex *force, *motion; /* [3 pairs], [3 probes] of one harmonic */
};

static shb_status make(const modal_model *model, witness *w) {
  SHB_TRY(mhb_balance_create(model, &w->settings, &w->residual));
  size_t n  = (size_t)w->residual->n;
  w->x      = calloc(n, sizeof *w->x);
  w->normal = calloc(n + 1, sizeof *w->normal);
  w->force  = calloc(3 * (size_t)model->n_pairs, sizeof *w->force);
  w->motion = calloc(3 * (size_t)model->n_probes + 1, sizeof *w->motion);
  SHB_CHECK(w->x && w->normal && w->force && w->motion, SHB_ERR_IO, "out of memory");
  return mhb_newton_create(w->residual->n, &w->newton);
}

shb_status witness_create(const modal_model *model, const mhb_settings *settings, int harmonics,
                          post_output output, witness **out) {
  witness *w = calloc(1, sizeof *w);
  SHB_CHECK(w, SHB_ERR_IO, "out of memory");
  w->settings                  = *settings;
  w->settings.harmonics        = harmonics;
  w->settings.motion_tolerance = 0;
  w->output                    = output;
  shb_status status            = make(model, w);
  if (status == SHB_OK) *out = w;
  if (status != SHB_OK) witness_destroy(w);
  return status;
}

void witness_destroy(witness *w) {
  if (!w) return;
  mhb_newton_destroy(w->newton);
  mhb_balance_destroy(w->residual);
  free(w->x);
  free(w->normal);
  free(w->force);
  free(w->motion);
  free(w);
}

/* to += factor times the motion of a point, less harmonics or more. */
static void add_motion(const witness *w, const witness_place *place, int point, double factor,
                       double *to) {
  const mhb_balance    *b = w->residual;
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

/* At the solution that the residual was just evaluated at. */
static double amplitude(const witness *w) {
  const mhb_balance *b = w->residual;
  int                k = w->settings.subharmonics <= b->m ? w->settings.subharmonics : b->m;
  if (w->output.place == POST_PLACE_PROBE) {
    mhb_balance_contact_force(b, k, w->force);
    mhb_receptance_probe(b->receptance, k, w->force, w->motion);
    return post_semi_major_axis(3, w->motion + 3 * (size_t)w->output.index, 1);
  }
  double complex u[3];
  for (int c = 0; c < 3; c++) {
    const double *a = w->x + (size_t)(3 * w->output.index + c) * (size_t)b->nb + (2 * k - 1);
    u[c]            = CMPLX(a[0], a[1]);
  }
  return post_semi_major_axis(3, u, 1);
}

int witness_solve(witness *w, const witness_place *place, bool same_frequency, double found[2]) {
  const mhb_settings *s    = &w->settings;
  mhb_balance        *b    = w->residual;
  const double       *f    = place->branch->frequency;
  size_t              n    = (size_t)b->n;
  double              span = SHB_TWO_PI * (s->frequency[1] - s->frequency[0]);
  memset(w->x, 0, n * sizeof *w->x);
  memset(w->normal, 0, (n + 1) * sizeof *w->normal);
  add_motion(w, place, place->from, 1 - place->part, w->x);
  add_motion(w, place, place->to, place->part, w->x);
  if (!same_frequency) {
    add_motion(w, place, place->low, -1, w->normal);
    add_motion(w, place, place->high, 1, w->normal);
  }
  w->normal[n] = same_frequency ? span : SHB_TWO_PI * (f[place->high] - f[place->low]);
  double omega = SHB_TWO_PI * ((1 - place->part) * f[place->from] + place->part * f[place->to]);
  double scale = mhb_norm(w->x, b->n);
  mhb_balance_set_preload(b, place->branch->n0[place->from]);
  if (!(scale > 0) || !mhb_nearest_solution(w->newton, b, w->normal, scale, span, w->x, &omega))
    return 0;
  found[0] = omega / SHB_TWO_PI;
  found[1] = amplitude(w);
  return 1;
}
