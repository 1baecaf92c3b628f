#include "mhb/structure/speed_derivative.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/numerics/lu.h"

static void differentiate(const mhb_speed_derivative *d) {
  if (d->disc)
    mhb_disc_speeds_differentiate(d->disc);
  else
    mhb_speed_model_differentiate(d->model[0]);
}

shb_status mhb_speed_derivative_create(mhb_speed_model **model, mhb_disc_speeds *disc,
                                       const modal_wave *wave, const mhb_modal_part *part,
                                       mhb_speed_derivative **out) {
  mhb_speed_derivative *d = shb_alloc_zeroed(1, sizeof *d);
  *d                      = (mhb_speed_derivative){.model = model, .disc = disc, .part = part};
  differentiate(d);
  const mhb_harmonics harmonics = {.nu              = part->nu,
                                   .n_harmonics     = part->n_harmonics,
                                   .phase           = part->phase,
                                   .wave            = wave,
                                   .nodal_diameters = disc != NULL};
  shb_status          status =
      mhb_modal_part_create(&model[0]->slope, part->relative, &harmonics, &d->slope);
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
  if (d->model[0]->slope_omega == d->model[0]->omega) return;
  differentiate(d);
  mhb_modal_part_update(d->slope);
}

/* x[m] <- L x */
static void respond(mhb_modal_solver L, int m, double complex *x) {
  if (L.lambda)
    for (int i = 0; i < m; i++) x[i] *= L.lambda[i];
  else
    mhb_solve_complex(m, L.factor, L.pivot, 1, x);
}

/* (dK + j w (dN + dG)) a of mode i. */
static double complex stiffness_change(const mhb_speed_derivative *d, int k, double w, int i,
                                       const double complex *a) {
  const mhb_speed_model *model = d->model[k];
  const int              m     = d->part->n_modes;
  double complex         sum   = 0;
  if (model->table->width == 1) {
    const double *dK = model->stiffness + i * m, *dN = model->damping + i * m;
    for (int j = 0; j < m; j++) sum += CMPLX(dK[j], w * dN[j]) * a[j];
    for (int j = 0; model->coriolis && j < m; j++)
      sum += I * w * mhb_speed_model_coriolis(model, i, j) * a[j];
    return sum;
  }
  const bool backward = d->part->wave[k].sign < 0;
  for (int j = 0; j < m; j++) {
    double complex dK = mhb_speed_model_stiffness(model, i, j);
    double complex dN = mhb_speed_model_damping(model, i, j);
    if (model->coriolis) dN += mhb_speed_model_coriolis(model, i, j);
    if (backward) { /* of the conjugate shapes */
      dK = conj(dK);
      dN = conj(dN);
    }
    sum += (dK + I * w * dN) * a[j];
  }
  return sum;
}

/* a = L d and its change with the model, L (dd - dA a): [modes] each. */
static void modal_change(const mhb_speed_derivative *d, int k, double w, mhb_modal_solver L,
                         double scale, const double complex *p, double complex *a,
                         double complex *change) {
  const int m = d->part->n_modes;
  for (int i = 0; i < m; i++) a[i] = mhb_modal_part_force(d->part, k, p, i, scale);
  respond(L, m, a);
  for (int i = 0; i < m; i++)
    change[i] = mhb_modal_part_force(d->slope, k, p, i, scale) - stiffness_change(d, k, w, i, a);
  respond(L, m, change);
}

/* d/d omega of the weights of the residual terms by w_m, the last mode kept. The weight of term t
 * is homogeneous of degree t in (w^2, w_m^2). */
static modal_series weight_slope(const mhb_speed_derivative *d, int k, const modal_series *s,
                                 double w) {
  const modal_model *model = d->part->wave[k].model;
  const int          last  = model->n_modes - 1;
  const double       top   = SHB_TWO_PI * model->frequency[last];
  const double       dc = creal(mhb_speed_model_stiffness(d->model[k], last, last)) / (top * top);
  modal_series       slope = {.x = 0};
  for (int t = 0; t < MODAL_TERMS; t++) {
    slope.weight[t]      = dc * (t * s->weight[t] - w * w * s->slope[t]);
    slope.load_weight[t] = model->load_fourth ? slope.weight[t] : 0;
  }
  return slope;
}

void mhb_speed_derivative_slope(const mhb_speed_derivative *d, int k, double w, mhb_modal_solver L,
                                double scale, const double complex *p, double complex *slope) {
  const mhb_modal_part *part = d->part;
  const int             m = part->n_modes, n = part->n;
  update(d);
  const modal_series    s  = modal_series_at(part->wave[k].model, w);
  const modal_series    ds = weight_slope(d, k, &s, w);
  const double complex *B  = part->B + (size_t)k * (size_t)n * (size_t)m;
  const double complex *dB = d->slope->B + (size_t)k * (size_t)n * (size_t)m;
  double complex        a[m], change[m];
  modal_change(d, k, w, L, scale, p, a, change);
  for (int row = 0; row < n; row++, B += m, dB += m)
    for (int i = 0; i < m; i++) slope[row] += dB[i] * a[i] + B[i] * change[i];
  mhb_residual_terms_motion_by(d->slope->residual_terms, k, &s, scale, p, slope);
  mhb_residual_terms_motion_by(part->residual_terms, k, &ds, scale, p, slope);
}

void mhb_speed_derivative_probe(const mhb_speed_derivative *d, int k, double w, mhb_modal_solver L,
                                double scale, const double complex *p, double d_omega,
                                double complex *change) {
  const modal_model *model = d->part->model;
  const int          m = model->n_modes, q = 3 * model->n_probes;
  update(d);
  const modal_series s = modal_series_at(d->part->wave[k].model, w), ds = weight_slope(d, k, &s, w);
  double complex     a[m], da[m], slope[q + 1];
  memset(slope, 0, sizeof slope);
  modal_change(d, k, w, L, scale, p, a, da);
  mhb_residual_terms_probe_by(d->slope->residual_terms, k, &s, scale, p, slope);
  mhb_residual_terms_probe_by(d->part->residual_terms, k, &ds, scale, p, slope);
  for (int c = 0; c < q; c++) {
    for (int i = 0; i < m; i++)
      slope[c] += mhb_modal_part_probe(d->slope, k, c, i, a[i]) +
                  mhb_modal_part_probe(d->part, k, c, i, da[i]);
    change[c] += d_omega * slope[c];
  }
}
