/* The largest distance between two instants of a periodic motion: its peak to peak.
 *
 *   x(t) = Re sum_{k=0..m} a_k e^{jkt},   D = max over t, s of |x(t) - x(s)|
 *
 * With one component it is max - min. Both instants make D stationary, so its derivative is the one
 * at fixed instants:
 *
 *   dD = Re sum_k sum_i e_i (e^{jkt} - e^{jks}) da_ik,   e the unit vector of the difference
 *
 * Where two pairs of instants are equally far apart D has a kink. */
#ifndef MHB_NUMERICS_EXTENT_H
#define MHB_NUMERICS_EXTENT_H

#include <complex.h>

typedef struct {
  double length;       /* D */
  double t, s;         /* rad, the instants */
  double direction[3]; /* e; 0 where D is 0 */
} mhb_extent;

/* a[n][m + 1], n <= 3. Sampled at 8 instants per period of the highest harmonic, then refined by
 * Newton's method on both instants to rounding. */
mhb_extent mhb_extent_of(int n, int m, const double complex *a);

/* weight[n] <- dD/da_k: dD = Re sum_i weight_i da_ik. Zero for k = 0. */
void mhb_extent_weight(const mhb_extent *extent, int n, int k, double complex *weight);

#endif
