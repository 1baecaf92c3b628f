/* Taylor series and trigonometric sums in long double, for the reference of the contact law.
 *
 * Nothing is shared with mhb: a reference with the same sums or root finder would share their
 * faults. A signal of m harmonics is a[2m+1] on the basis 1, cos kt, -sin kt. A series is c[order +
 * 1], sum_j c_j t^j. */
#ifndef TESTS_SUPPORT_SERIES_H
#define TESTS_SUPPORT_SERIES_H

typedef long double real;

enum { SERIES_ORDER = 30, SERIES_HARMONICS = 24, GAUSS_NODES = 16 };

/* Value (derivative 0) or first derivative (1) of a signal at t. */
real signal_at(int m, const real *a, real t, int derivative);

/* Taylor coefficients of a signal about t. */
void series_of_signal(int m, const real *a, real t, int order, real *c);

real series_at(const real *c, int order, real t);

/* Coefficient j of the product of two series. */
real series_product(const real *a, const real *b, int j);

/* First t in [0, h] at which the polynomial changes from negative to positive; negative if there is
 * none. Extremes between the points of a grid are found by the sign of the slope, so short
 * excursions count. */
real series_upcrossing(const real *c, int order, real h);

/* Roots of a signal in [0, 2 pi), ascending, at most `room`; returns their number. rising[i]: from
 * negative to positive. */
int signal_roots(int m, const real *a, int room, real *root, int *rising);

/* Gauss-Legendre nodes and weights on [0, 1]. */
void gauss_rule(real node[GAUSS_NODES], real weight[GAUSS_NODES]);

#endif
