#include "mhb/tracking/output_amplitude.h"

#include <math.h>
#include <string.h>

#include "mhb/continuation/outputs.h"

static double squared(double complex a) {
  return creal(a) * creal(a) + cimag(a) * cimag(a);
}

/* The amplitude of a[3], and w: dA = Re sum w_i da_i. */
static double size_of(mhb_size size, const double complex a[3], double complex w[3]) {
  double         sum = squared(a[0]) + squared(a[1]) + squared(a[2]);
  double complex Q   = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
  if (size == MHB_SIZE_ROOT_SUM) Q = 0;
  double         length = cabs(Q), most = size == MHB_SIZE_ROOT_SUM ? sum : 0.5 * (sum + length);
  double         A = sqrt(most), part = size == MHB_SIZE_ROOT_SUM ? 1 : 0.5;
  double complex turn = length > 0 ? conj(Q) / length : 0;
  for (int i = 0; i < 3; i++) w[i] = A > 0 ? part * (conj(a[i]) + turn * a[i]) / A : 0;
  return A;
}

/* Of a pair's relative motion: x itself. */
static void of_pair(const mhb_balance *b, const double *x, int pair, int k, mhb_amplitude *out) {
  double complex a[3], w[3];
  size_t         at[3];
  for (int axis = 0; axis < 3; axis++) {
    at[axis] = (size_t)(3 * pair + axis) * (size_t)b->nb + (size_t)(2 * k - 1);
    a[axis]  = CMPLX(x[at[axis]], x[at[axis] + 1]);
  }
  out->amplitude = size_of(out->size, a, w);
  for (int axis = 0; axis < 3; axis++) {
    out->by_x[at[axis]]     = creal(w[axis]);
    out->by_x[at[axis] + 1] = -cimag(w[axis]);
  }
}

/* Re sum over the components of w change */
static double along(const double complex w[3], const double complex *change) {
  double sum = 0;
  for (int axis = 0; axis < 3; axis++) sum += creal(w[axis] * change[axis]);
  return sum;
}

static void of_probe(mhb_balance *b, int probe, int k, mhb_amplitude *out) {
  mhb_receptance *r = b->receptance;
  int             n = r->n, probes = 3 * r->model->n_probes;
  double complex  p[n], dp[n], q[probes], change[probes], w[3];
  mhb_receptance_update(r, k);
  mhb_balance_contact_force(b, k, p);
  mhb_receptance_probe(r, k, p, q);
  const double complex *da = change + 3 * probe;
  out->amplitude           = size_of(out->size, q + 3 * probe, w);
  if (out->amplitude == 0) return;
  memset(dp, 0, sizeof dp);
  mhb_receptance_probe_change(r, k, p, dp, 1, 0, change);
  out->by_omega = along(w, da);
  mhb_receptance_probe_change(r, k, p, dp, 0, 1, change);
  out->by_scale = along(w, da);
  mhb_receptance_by_damping(r, k, p, dp, change);
  out->by_damping = along(w, da);
  memset(dp, 0, sizeof dp);
  for (int i = 0; i < n; i++) {
    dp[i] = 1;
    mhb_receptance_probe_change(r, k, p, dp, 0, 0, change);
    dp[i]          = 0;
    out->weight[i] = 0;
    for (int axis = 0; axis < 3; axis++) out->weight[i] += w[axis] * da[axis];
  }
  double *re = out->by_x, im[3 * b->nb];
  for (int pair = 0; pair < b->n_pairs; pair++, re += 3 * b->nb) {
    memset(im, 0, sizeof im);
    mhb_balance_row_times_dp(b, out->weight + 3 * pair, pair, k, re, im);
  }
}

void mhb_output_amplitude(mhb_balance *b, const double *x, int output, mhb_amplitude *out) {
  int k = mhb_output_harmonic(b), probes = b->receptance->model->n_probes;
  out->amplitude = out->by_omega = out->by_scale = out->by_damping = 0;
  memset(out->by_x, 0, sizeof(double) * (size_t)b->n);
  memset(out->weight, 0, sizeof(double complex) * 3 * (size_t)b->n_pairs);
  if (output < probes) of_probe(b, output, k, out);
  if (output >= probes) of_pair(b, x, output - probes, k, out);
}

double mhb_amplitude_by_parameter(const mhb_balance *b, const mhb_amplitude *amplitude,
                                  mhb_parameter parameter, const double *by_parameter) {
  int    k   = mhb_output_harmonic(b);
  double sum = 0;
  if (parameter == MHB_IN_FREQUENCY) return amplitude->by_omega;
  if (parameter == MHB_IN_SCALE) return amplitude->by_scale;
  for (int row = 0; row < 3 * b->n_pairs; row++) {
    const double *p = by_parameter + (size_t)row * (size_t)b->nb + (size_t)(2 * k - 1);
    sum += creal(amplitude->weight[row] * CMPLX(p[0], p[1]));
  }
  return sum;
}

void mhb_slope_by_damping(mhb_balance *b, double *slope) {
  int            n = 3 * b->n_pairs;
  double complex p[n], motion[n], probe[3 * b->receptance->model->n_probes + 1];
  for (int k = 0; k <= b->m; k++) {
    mhb_receptance_update(b->receptance, k);
    mhb_balance_contact_force(b, k, p);
    mhb_receptance_by_damping(b->receptance, k, p, motion, probe);
    for (int row = 0; row < n; row++) {
      double *to = slope + (size_t)row * (size_t)b->nb + (k ? 2 * k - 1 : 0);
      to[0]      = -creal(motion[row]);
      if (k) to[1] = -cimag(motion[row]);
    }
  }
}
