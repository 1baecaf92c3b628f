#include "mhb/structure/speed_derivative.h"

#include <string.h>

#include "mesh/base/constants.h"

/* The rate at the model's omega. */
static const mhb_receptance *rate_of(const mhb_receptance *r) {
  if (r->rate->omega == r->omega) return r->rate;
  mhb_speed_model_differentiate(r->at);
  mhb_receptance_set(r->rate);
  r->rate->omega = r->omega;
  return r->rate;
}

/* a = L d, d = scale F - B^H p, and its change with the model, L (d' - (dK + j w dN) a): [modes] each. */
static void modal_rate(const mhb_receptance *r, int k, const double complex *p, double complex *a,
                       double complex *change) {
  const mhb_receptance *rate = rate_of(r);
  const int             m    = r->n_modes;
  const double          w    = k * r->omega / r->nu;
  for (int i = 0; i < m; i++)
    a[i] = r->lambda[k * m + i] * mhb_receptance_modal_load(r, k, p, i, r->scale);
  for (int i = 0; i < m; i++) {
    const double  *dK = r->at->stiffness + i * m, *dN = r->at->damping + i * m;
    double complex sum = mhb_receptance_modal_load(rate, k, p, i, r->scale);
    for (int j = 0; j < m; j++) sum -= CMPLX(dK[j], w * dN[j]) * a[j];
    change[i] = r->lambda[k * m + i] * sum;
  }
}

/* d/d omega of the weights of the residual terms by w_m, the last mode kept: weight t is of degree t in (w^2, w_m^2). */
static modal_series weight_rate(const mhb_receptance *r, const modal_series *s, double w) {
  const int    last = r->n_modes - 1;
  const double top  = SHB_TWO_PI * r->model->frequency[last];
  const double dc   = r->at->stiffness[last * r->n_modes + last] / (top * top);
  modal_series rate = {.x = 0};
  for (int t = 0; t < MODAL_TERMS; t++) {
    rate.weight[t]      = dc * (t * s->weight[t] - w * w * s->slope[t]);
    rate.load_weight[t] = r->model->load_fourth ? rate.weight[t] : 0;
  }
  return rate;
}

void mhb_speed_derivative_slope(const mhb_receptance *r, int k, const double complex *p,
                                double complex *slope) {
  const int             m = r->n_modes, n = r->n;
  const double          w    = k * r->omega / r->nu;
  const mhb_receptance *rate = rate_of(r);
  const modal_series    s = modal_series_at(r->model, w), by_weights = weight_rate(r, &s, w);
  const double complex *B  = r->B + (size_t)k * (size_t)n * (size_t)m;
  const double complex *dB = rate->B + (size_t)k * (size_t)n * (size_t)m;
  double complex        a[m], change[m];
  modal_rate(r, k, p, a, change);
  for (int row = 0; row < n; row++, B += m, dB += m)
    for (int i = 0; i < m; i++) slope[row] += dB[i] * a[i] + B[i] * change[i];
  mhb_residual_terms_motion_by(rate->left_out, k, &s, r->scale, p, slope);
  mhb_residual_terms_motion_by(r->left_out, k, &by_weights, r->scale, p, slope);
}

void mhb_speed_derivative_probe(const mhb_receptance *r, int k, const double complex *p,
                                double d_omega, double complex *change) {
  const int             m = r->n_modes, q = 3 * r->model->n_probes;
  const double          w    = k * r->omega / r->nu;
  const mhb_receptance *rate = rate_of(r);
  const modal_series    s = modal_series_at(r->model, w), by_weights = weight_rate(r, &s, w);
  double complex        a[m], by[m], residual[q + 1];
  memset(residual, 0, sizeof residual);
  modal_rate(r, k, p, a, by);
  mhb_residual_terms_probe_by(rate->left_out, k, &s, r->scale, p, residual);
  mhb_residual_terms_probe_by(r->left_out, k, &by_weights, r->scale, p, residual);
  for (int c = 0; c < q; c++) {
    const double *psi = r->model->probe + c * m, *d_psi = rate->model->probe + c * m;
    for (int i = 0; i < m; i++) residual[c] += d_psi[i] * a[i] + psi[i] * by[i];
    change[c] += d_omega * residual[c];
  }
}
