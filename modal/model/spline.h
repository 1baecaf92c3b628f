/* Interpolation of many functions given at the same places: the cubic spline whose first two and last two pieces are one cubic
 * (not-a-knot), fourth order; the parabola of three places, the line of two, the constant of one.
 *
 * The spline of values y is sum_i w_i(x) y_i: the weights serve every function. Source: de Boor 1978, ch. IV. */
#ifndef MODAL_MODEL_SPLINE_H
#define MODAL_MODEL_SPLINE_H

#include "mesh/base/status.h"

typedef struct {
  int     n;
  double *x;      /* [n] ascending, distinct */
  double *second; /* [n][n] second derivative at place i of the spline that is 1 at place j */
} modal_spline;

/* Errors: SHB_ERR_IO no memory. */
shb_status modal_spline_create(int n, const double *x, modal_spline *spline);

/* Weights at x, [n], and their derivatives (or NULL); beyond the ends the last piece goes on. */
void modal_spline_weights(const modal_spline *spline, double x, double *weight, double *slope);

void modal_spline_free(modal_spline *spline); /* also on a zeroed struct */

#endif
