#include "mhb/structure/speed_derivative.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

shb_status mhb_speed_derivative_create(mhb_speed_model *model, const mhb_modal_part *part,
                                       mhb_speed_derivative **out) {
  mhb_speed_derivative *d = calloc(1, sizeof *d);
  SHB_CHECK(d, SHB_ERR_IO, "out of memory");
  d->model = model;
  d->part  = part;
  mhb_speed_model_differentiate(model);
  const mhb_harmonics harmonics = {
      .nu = part->nu, .n_harmonics = part->n_harmonics, .phase = part->phase};
  shb_status status = mhb_modal_part_create(&model->slope, part->relative, &harmonics, &d->slope);
  if (status != SHB_OK) {
    free(d);
    return status;
  }
  *out = d;
  return SHB_OK;
}

void mhb_speed_derivative_destroy(mhb_speed_derivative *d) {
  if (!d) return;
  mhb_modal_part_destroy(d->slope);
  free(d);
}

/* The slope at the model's omega. */
static void update(const mhb_speed_derivative *d) {
  if (d->model->slope_omega == d->model->omega) return;
  mhb_speed_model_differentiate(d->model);
  mhb_modal_part_update(d->slope);
}

/* a = L d and its change with the model, L (dd - (dK + j w dN) a): [modes] each. */
static void modal_change(const mhb_speed_derivative *d, int k, double w,
                         const double complex *lambda, double scale, const double complex *p,
                         double complex *a, double complex *change) {
  const int m = d->part->n_modes;
  for (int i = 0; i < m; i++) a[i] = lambda[i] * mhb_modal_part_force(d->part, k, p, i, scale);
  for (int i = 0; i < m; i++) {
    const double  *dK = d->model->stiffness + i * m, *dN = d->model->damping + i * m;
    double complex sum = mhb_modal_part_force(d->slope, k, p, i, scale);
    for (int j = 0; j < m; j++) sum -= CMPLX(dK[j], w * dN[j]) * a[j];
    change[i] = lambda[i] * sum;
  }
}

/* d/d omega of the weights of the residual terms by w_m, the last mode kept. The weight of term t
 * is homogeneous of degree t in (w^2, w_m^2). */
static modal_series weight_slope(const mhb_speed_derivative *d, const modal_series *s, double w) {
  const modal_model *model = d->part->model;
  const int          last  = model->n_modes - 1;
  const double       top   = SHB_TWO_PI * model->frequency[last];
  const double       dc    = d->model->stiffness[last * model->n_modes + last] / (top * top);
  modal_series       slope = {.x = 0};
  for (int t = 0; t < MODAL_TERMS; t++) {
    slope.weight[t]      = dc * (t * s->weight[t] - w * w * s->slope[t]);
    slope.load_weight[t] = model->load_fourth ? slope.weight[t] : 0;
  }
  return slope;
}

void mhb_speed_derivative_slope(const mhb_speed_derivative *d, int k, double w,
                                const double complex *lambda, double scale, const double complex *p,
                                double complex *slope) {
  const mhb_modal_part *part = d->part;
  const int             m = part->n_modes, n = part->n;
  update(d);
  const modal_series    s = modal_series_at(part->model, w), ds = weight_slope(d, &s, w);
  const double complex *B  = part->B + (size_t)k * (size_t)n * (size_t)m;
  const double complex *dB = d->slope->B + (size_t)k * (size_t)n * (size_t)m;
  double complex        a[m], change[m];
  modal_change(d, k, w, lambda, scale, p, a, change);
  for (int row = 0; row < n; row++, B += m, dB += m)
    for (int i = 0; i < m; i++) slope[row] += dB[i] * a[i] + B[i] * change[i];
  mhb_residual_terms_motion_by(d->slope->residual_terms, k, &s, scale, p, slope);
  mhb_residual_terms_motion_by(part->residual_terms, k, &ds, scale, p, slope);
}

void mhb_speed_derivative_probe(const mhb_speed_derivative *d, int k, double w,
                                const double complex *lambda, double scale, const double complex *p,
                                double d_omega, double complex *change) {
  const modal_model *model = d->part->model;
  const int          m = model->n_modes, q = 3 * model->n_probes;
  update(d);
  const modal_series s = modal_series_at(model, w), ds = weight_slope(d, &s, w);
  double complex     a[m], da[m], slope[q + 1];
  memset(slope, 0, sizeof slope);
  modal_change(d, k, w, lambda, scale, p, a, da);
  mhb_residual_terms_probe_by(d->slope->residual_terms, k, &s, scale, p, slope);
  mhb_residual_terms_probe_by(d->part->residual_terms, k, &ds, scale, p, slope);
  for (int c = 0; c < q; c++) {
    const double *psi = model->probe + c * m, *d_psi = d->slope->model->probe + c * m;
    for (int i = 0; i < m; i++) slope[c] += d_psi[i] * a[i] + psi[i] * da[i];
    change[c] += d_omega * slope[c];
  }
}
