#include "mhb/continuation/outputs.h"

#include <math.h>
#include <string.h>

#include "mhb/numerics/extent.h"
#include "mhb/structure/ring_receptance.h"

/* Relative slope below which an output counts as flat. */
static const double FLAT = 1e-9;

/* Places of a blade of a ring whose amplitudes are outputs. */
static int ring_places(const mhb_balance *b) {
  const int probes = b->receptance->ring->ring->n_probes;
  return probes > 0 ? probes : 1;
}

int mhb_outputs(const mhb_balance *b) {
  if (b->receptance->ring) return 2 * ring_places(b);
  int pairs = b->n_pairs < 2 ? b->n_pairs : 2;
  return b->receptance->model->n_probes + 3 * pairs;
}

int mhb_output_harmonic(const mhb_balance *b) {
  const int wanted = b->settings->output_harmonic, nu = b->receptance->nu;
  const int k = nu * (wanted > 1 ? wanted : 1);
  return k <= b->m ? k : b->m;
}

/* Change of the contact forces along dx and with the parameter by dvalue, harmonic k. */
static void force_change(const mhb_balance *b, const double *dx, double dvalue, int k,
                         double complex *dp) {
  int block = 3 * b->nb;
  for (int row = 0; row < 3 * b->n_pairs; row++) {
    int           pair = row / 3, first = (row % 3) * b->nb + (k ? 2 * k - 1 : 0);
    const double *re = b->eval->dp + ((size_t)pair * (size_t)block + (size_t)first) * (size_t)block;
    const double *by = b->eval->by_parameter + (size_t)pair * (size_t)block + first;
    double        sum[2] = {dvalue * by[0], k ? dvalue * by[1] : 0};
    for (int j = 0; j < block; j++) {
      sum[0] += re[j] * dx[pair * block + j];
      if (k) sum[1] += re[block + j] * dx[pair * block + j];
    }
    dp[row] = CMPLX(sum[0], sum[1]);
  }
}

/* dA of a motion's three components that change by dz. */
static double change(const double complex w[3], const double complex dz[3]) {
  return creal(w[0] * dz[0] + w[1] * dz[1] + w[2] * dz[2]);
}

/* Where nothing changes (another parameter than the frequency, all stuck) the sign of a slope is
 * noise. */
static double unless_flat(double slope, double square) {
  return fabs(slope) > FLAT * square ? slope : 0;
}

void mhb_probe_change(mhb_balance *b, const mhb_curve_point *point, int k, double complex *q,
                      double complex *dq) {
  double         dvalue = point->tangent[b->n];
  double complex p[b->receptance->n], dp[b->receptance->n];
  mhb_balance_use(b, point->evaluation);
  mhb_balance_update_probes(b, k);
  mhb_balance_contact_force(b, k, p);
  force_change(b, point->tangent, dvalue, k, dp);
  mhb_receptance_probe(b->receptance, k, p, q);
  mhb_receptance_probe_change(b->receptance, k, p, dp,
                              b->parameter == MHB_IN_FREQUENCY ? dvalue : 0,
                              b->parameter == MHB_IN_SCALE ? dvalue : 0, dq);
}

/* d D^2/ds of the peak to peak of harmonics a[n][m + 1] that change by da. */
static double extent_slope(int n, int m, const double complex *a, const double complex *da) {
  const mhb_extent extent = mhb_extent_of(n, m, a);
  double           sum    = 0;
  double complex   w[3];
  for (int k = 1; k <= m; k++) {
    mhb_extent_weight(&extent, n, k, w);
    for (int i = 0; i < n; i++) sum += creal(w[i] * da[i * (m + 1) + k]);
  }
  return unless_flat(2 * extent.length * sum, extent.length * extent.length);
}

/* The same of output o, which is a probe, or v, u, w of a pair. */
static double peak_to_peak_slope(mhb_balance *b, const mhb_curve_point *point, int o) {
  const int      probes = b->receptance->model->n_probes, m = b->m, K = m + 1;
  double complex a[3 * K], da[3 * K], q[3 * probes + 1], dq[3 * probes + 1];
  memset(a, 0, sizeof a);
  memset(da, 0, sizeof da);
  for (int k = 1; k <= m; k++) {
    if (o >= probes) {
      const size_t  at = (size_t)(o - probes) * (size_t)b->nb + (size_t)(2 * k - 1);
      const double *x = point->x + at, *dx = point->tangent + at;
      a[k]  = CMPLX(x[0], x[1]);
      da[k] = CMPLX(dx[0], dx[1]);
      continue;
    }
    mhb_probe_change(b, point, k, q, dq);
    for (int axis = 0; axis < 3; axis++) {
      a[axis * K + k]  = q[3 * o + axis];
      da[axis * K + k] = dq[3 * o + axis];
    }
  }
  return extent_slope(o < probes ? 3 : 1, m, a, da);
}

/* Motion z[3] at a place of a blade, and its change dz along the tangent. Without probes: of the
 * first pair. */
static void ring_motion(const mhb_balance *b, const mhb_curve_point *point, int k, int blade,
                        const double complex *q, const double complex *dq, double complex z[3],
                        double complex dz[3]) {
  const mhb_ring_receptance *ring = b->receptance->ring;
  for (int axis = 0; axis < 3; axis++) {
    const size_t  at = (size_t)(blade * ring->n + axis) * (size_t)b->nb + (size_t)(2 * k - 1);
    const double *a = point->x + at, *da = point->tangent + at;
    z[axis]  = ring->q > 0 ? q[blade * ring->q + axis] : CMPLX(a[0], a[1]);
    dz[axis] = ring->q > 0 ? dq[blade * ring->q + axis] : CMPLX(da[0], da[1]);
  }
}

/* Output o of a ring: on the blade that swings highest, or a times the slope of the mean. */
static double ring_slope(mhb_balance *b, const mhb_curve_point *point, int k, int o) {
  const mhb_ring_receptance *ring = b->receptance->ring;
  const int                  all = ring->blades * ring->q, places = ring_places(b);
  const int                  place = 3 * (o % places), N = ring->blades;
  double complex             q[all + 1], dq[all + 1], z[3], dz[3];
  double                     most = -1, slope = 0, mean = 0, by_mean = 0;
  double complex             w[3];
  if (ring->q > 0) mhb_probe_change(b, point, k, q, dq);
  for (int blade = 0; blade < N; blade++) {
    ring_motion(b, point, k, blade, q + place, dq + place, z, dz);
    const double a = mhb_semi_major_weight(z, w), da = change(w, dz);
    if (a > most) {
      most  = a;
      slope = da;
    }
    mean += a / N;
    by_mean += da / N;
  }
  return o < places ? unless_flat(2 * most * slope, most * most)
                    : unless_flat(2 * mean * by_mean, mean * mean);
}

double mhb_output_slope(mhb_balance *b, const mhb_curve_point *point, int o) {
  const mhb_receptance *r      = b->receptance;
  int                   probes = r->model->n_probes, k = mhb_output_harmonic(b);
  if (r->ring) return ring_slope(b, point, k, o);
  if (b->settings->output_quantity == MHB_OUTPUT_PEAK_TO_PEAK)
    return peak_to_peak_slope(b, point, o);
  if (o >= probes) {
    size_t        at = (size_t)(o - probes) * (size_t)b->nb + (size_t)(2 * k - 1);
    const double *a = point->x + at, *da = point->tangent + at;
    return unless_flat(2 * (a[0] * da[0] + a[1] * da[1]), a[0] * a[0] + a[1] * a[1]);
  }
  double complex q[3 * probes], dq[3 * probes];
  mhb_probe_change(b, point, k, q, dq);
  double complex w[3];
  const bool     rss = b->settings->output_quantity == MHB_OUTPUT_RSS;
  const double   a   = (rss ? mhb_rss_weight : mhb_semi_major_weight)(q + 3 * o, w);
  return unless_flat(2 * a * change(w, dq + 3 * o), a * a);
}
