#include "mhb/tracking/output_amplitude.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "mhb/continuation/outputs.h"
#include "mhb/numerics/extent.h"

/* Harmonics first to last enter the amplitude. */
typedef struct {
  int first, last;
} span;

static span span_of(const mhb_balance *b, mhb_size size) {
  const int k = mhb_output_harmonic(b);
  return size == MHB_SIZE_PEAK_TO_PEAK ? (span){1, b->m} : (span){k, k};
}

/* The amplitude of harmonics a[3][m + 1], and w[m + 1][3]: dA = Re sum w_ki da_ik. */
static double peak_to_peak(int m, const double complex *a, double complex *w) {
  const mhb_extent extent = mhb_extent_of(3, m, a);
  for (int k = 0; k <= m; k++) mhb_extent_weight(&extent, 3, k, w + (ptrdiff_t)3 * k);
  return extent.length;
}

/* The amplitude of a[3], and w: dA = Re sum w_i da_i. */
static double of_harmonic(mhb_size size, const double complex a[3], double complex w[3]) {
  return size == MHB_SIZE_RSS ? mhb_rss_weight(a, w) : mhb_semi_major_weight(a, w);
}

/* The same of the amplitude asked for; other harmonics than those of the span are not read. */
static double size_of(const mhb_balance *b, mhb_size size, const double complex *a,
                      double complex *w) {
  const int m = b->m, k = mhb_output_harmonic(b);
  if (size == MHB_SIZE_PEAK_TO_PEAK) return peak_to_peak(m, a, w);
  return of_harmonic(size, (double complex[3]){a[k], a[m + 1 + k], a[2 * (m + 1) + k]},
                     w + (ptrdiff_t)3 * k);
}

/* Of a pair's relative motion: x itself. */
static void of_pair(const mhb_balance *b, const double *x, int pair, mhb_amplitude *out) {
  const span     of = span_of(b, out->size);
  const int      m  = b->m;
  double complex a[3 * (m + 1)], w[3 * (m + 1)];
  memset(a, 0, sizeof a);
  for (int axis = 0; axis < 3; axis++)
    for (int k = of.first; k <= of.last; k++) {
      const double *to      = x + (ptrdiff_t)(3 * pair + axis) * b->nb + (2 * k - 1);
      a[axis * (m + 1) + k] = CMPLX(to[0], to[1]);
    }
  out->amplitude = size_of(b, out->size, a, w);
  for (int axis = 0; axis < 3; axis++)
    for (int k = of.first; k <= of.last; k++) {
      double *to = out->by_x + (ptrdiff_t)(3 * pair + axis) * b->nb + (2 * k - 1);
      to[0]      = creal(w[3 * k + axis]);
      to[1]      = -cimag(w[3 * k + axis]);
    }
}

/* Re sum over the components of w change */
static double along(const double complex w[3], const double complex *change) {
  double sum = 0;
  for (int axis = 0; axis < 3; axis++) sum += creal(w[axis] * change[axis]);
  return sum;
}

/* What harmonic k of a probe adds to the gradient, dA = Re sum w da. */
static void add_gradient(mhb_balance *b, int probe, int k, const double complex w[3],
                         mhb_amplitude *out) {
  mhb_receptance       *r = b->receptance;
  int                   n = r->n, probes = 3 * r->model->n_probes;
  double complex        p[n], dp[n], change[probes], *weight = out->weight + (ptrdiff_t)k * n;
  const double complex *da = change + 3 * probe;
  mhb_receptance_update(r, k);
  mhb_balance_contact_force(b, k, p);
  memset(dp, 0, sizeof dp);
  mhb_receptance_probe_change(r, k, p, dp, 1, 0, change);
  out->by_omega += along(w, da);
  mhb_receptance_probe_change(r, k, p, dp, 0, 1, change);
  out->by_scale += along(w, da);
  mhb_receptance_by_damping(r, k, p, dp, change);
  out->by_damping += along(w, da);
  memset(dp, 0, sizeof dp);
  for (int i = 0; i < n; i++) {
    dp[i] = 1;
    mhb_receptance_probe_change(r, k, p, dp, 0, 0, change);
    dp[i]     = 0;
    weight[i] = 0;
    for (int axis = 0; axis < 3; axis++) weight[i] += w[axis] * da[axis];
  }
  double *re = out->by_x, im[3 * b->nb];
  for (int pair = 0; pair < b->n_pairs; pair++, re += 3 * b->nb) {
    memset(im, 0, sizeof im);
    mhb_balance_row_times_dp(b, weight + 3 * pair, pair, k, re, im);
  }
}

static void of_probe(mhb_balance *b, int probe, mhb_amplitude *out) {
  mhb_receptance *r  = b->receptance;
  const span      of = span_of(b, out->size);
  const int       m = b->m, probes = 3 * r->model->n_probes;
  double complex  p[r->n], q[probes], a[3 * (m + 1)], w[3 * (m + 1)];
  memset(a, 0, sizeof a);
  for (int k = of.first; k <= of.last; k++) {
    mhb_receptance_update(r, k);
    mhb_balance_contact_force(b, k, p);
    mhb_receptance_probe(r, k, p, q);
    for (int axis = 0; axis < 3; axis++) a[axis * (m + 1) + k] = q[3 * probe + axis];
  }
  out->amplitude = size_of(b, out->size, a, w);
  if (out->amplitude == 0) return;
  for (int k = of.first; k <= of.last; k++) add_gradient(b, probe, k, w + (ptrdiff_t)3 * k, out);
}

void mhb_output_amplitude(mhb_balance *b, const double *x, int output, mhb_amplitude *out) {
  const int probes = b->receptance->model->n_probes;
  out->amplitude = out->by_omega = out->by_scale = out->by_damping = 0;
  memset(out->by_x, 0, sizeof(double) * (size_t)b->n);
  memset(out->weight, 0, sizeof *out->weight * mhb_amplitude_weights(b));
  if (output < probes) of_probe(b, output, out);
  if (output >= probes) of_pair(b, x, output - probes, out);
}

size_t mhb_amplitude_weights(const mhb_balance *b) {
  return 3 * (size_t)b->n_pairs * ((size_t)b->m + 1);
}

double mhb_amplitude_by_parameter(const mhb_balance *b, const mhb_amplitude *amplitude,
                                  mhb_parameter parameter, const double *by_parameter) {
  const span of  = span_of(b, amplitude->size);
  const int  n   = 3 * b->n_pairs;
  double     sum = 0;
  if (parameter == MHB_IN_FREQUENCY) return amplitude->by_omega;
  if (parameter == MHB_IN_SCALE) return amplitude->by_scale;
  for (int k = of.first; k <= of.last; k++)
    for (int row = 0; row < n; row++) {
      const double *p = by_parameter + (ptrdiff_t)row * b->nb + (2 * k - 1);
      sum += creal(amplitude->weight[(ptrdiff_t)k * n + row] * CMPLX(p[0], p[1]));
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
