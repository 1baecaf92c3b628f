/* Sizes of a periodic motion: the largest distance between two instants, its peak to peak, and the
 * size of one harmonic.
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

/* The amplitude of a harmonic: the largest length of Re a e^{jt} in a cycle, the semi-major axis of
 * its ellipse,
 *
 *   A^2 = (sum |a_i|^2 + |sum a_i^2|)/2; |a| for n = 1.
 *
 *   a  in  [n], stride apart */
double mhb_semi_major_axis(int n, const double complex *a, int stride);

/* The same of a[3], and weight[3] = dA/da: dA = Re sum weight_i da_i; 0 where A is. On a circle A
 * has no gradient; that of one of the directions is given. */
double mhb_semi_major_weight(const double complex a[3], double complex weight[3]);

/* The root of the sum of the squared components of a[3], and its weight: rss. It is A where all
 * components move in phase, 2^1/2 A on a circle. */
double mhb_rss_weight(const double complex a[3], double complex weight[3]);

#endif
