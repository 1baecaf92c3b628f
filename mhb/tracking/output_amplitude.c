#include "mhb/tracking/output_amplitude.h"

#include <math.h>
#include <string.h>

/* The harmonic of the excitation. */
static int driven_harmonic(const mhb_balance *b) {
  return b->receptance->nu <= b->m ? b->receptance->nu : b->m;
}

static double squared(double complex a) {
  return creal(a) * creal(a) + cimag(a) * cimag(a);
}

/* Of a pair's relative motion: x itself. */
static void of_pair(const mhb_balance *b, const double *x, int pair, int k, mhb_amplitude *out) {
  double sum = 0;
  size_t at[3];
  for (int axis = 0; axis < 3; axis++) {
    at[axis] = (size_t)(3 * pair + axis) * (size_t)b->nb + (size_t)(2 * k - 1);
    sum += x[at[axis]] * x[at[axis]] + x[at[axis] + 1] * x[at[axis] + 1];
  }
  out->amplitude = sqrt(sum);
  for (int axis = 0; axis < 3 && sum > 0; axis++)
    for (size_t i = at[axis]; i < at[axis] + 2; i++) out->by_x[i] = x[i] / out->amplitude;
}

/* Re sum over the components of conj(a) change / A */
static double along(const double complex *a, const double complex *change, double amplitude) {
  double sum = 0;
  for (int axis = 0; axis < 3; axis++) sum += creal(conj(a[axis]) * change[axis]);
  return sum / amplitude;
}

static void of_probe(mhb_balance *b, int probe, int k, mhb_amplitude *out) {
  mhb_receptance *r = b->receptance;
  int             n = r->n, probes = 3 * r->model->n_probes;
  double complex  p[n], dp[n], q[probes], change[probes];
  mhb_receptance_update(r, k);
  mhb_balance_contact_force(b, k, p);
  mhb_receptance_probe(r, k, p, q);
  const double complex *a = q + 3 * probe, *da = change + 3 * probe;
  out->amplitude = sqrt(squared(a[0]) + squared(a[1]) + squared(a[2]));
  if (out->amplitude == 0) return;
  memset(dp, 0, sizeof dp);
  mhb_receptance_probe_change(r, k, p, dp, 1, 0, change);
  out->by_omega = along(a, da, out->amplitude);
  mhb_receptance_probe_change(r, k, p, dp, 0, 1, change);
  out->by_scale = along(a, da, out->amplitude);
  for (int i = 0; i < n; i++) {
    dp[i] = 1;
    mhb_receptance_probe_change(r, k, p, dp, 0, 0, change);
    dp[i]          = 0;
    out->weight[i] = 0;
    for (int axis = 0; axis < 3; axis++)
      out->weight[i] += conj(a[axis]) * da[axis] / out->amplitude;
  }
  double *re = out->by_x, im[3 * b->nb];
  for (int pair = 0; pair < b->n_pairs; pair++, re += 3 * b->nb) {
    memset(im, 0, sizeof im);
    mhb_balance_row_times_dp(b, out->weight + 3 * pair, pair, k, re, im);
  }
}

void mhb_output_amplitude(mhb_balance *b, const double *x, int output, mhb_amplitude *out) {
  int k = driven_harmonic(b), probes = b->receptance->model->n_probes;
  out->amplitude = out->by_omega = out->by_scale = 0;
  memset(out->by_x, 0, sizeof(double) * (size_t)b->n);
  memset(out->weight, 0, sizeof(double complex) * 3 * (size_t)b->n_pairs);
  if (output < probes) of_probe(b, output, k, out);
  if (output >= probes) of_pair(b, x, output - probes, k, out);
}

double mhb_amplitude_by_parameter(const mhb_balance *b, const mhb_amplitude *amplitude,
                                  mhb_parameter parameter, const double *by_parameter) {
  int    k   = driven_harmonic(b);
  double sum = 0;
  if (parameter == MHB_IN_FREQUENCY) return amplitude->by_omega;
  if (parameter == MHB_IN_SCALE) return amplitude->by_scale;
  for (int row = 0; row < 3 * b->n_pairs; row++) {
    const double *p = by_parameter + (size_t)row * (size_t)b->nb + (size_t)(2 * k - 1);
    sum += creal(amplitude->weight[row] * CMPLX(p[0], p[1]));
  }
  return sum;
}
