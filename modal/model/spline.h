/* Cubic spline with not-a-knot end conditions, for many functions on the same grid. It is of fourth
 * order. Three points give the parabola, two the line, one the constant.
 *
 * The spline of values y is sum_i w_i(x) y_i: the weights serve every function. Source: de Boor
 * 1978, ch. IV. */
#ifndef MODAL_MODEL_SPLINE_H
#define MODAL_MODEL_SPLINE_H

typedef struct {
  int     n;
  double *x;      /* [n] ascending, distinct */
  double *second; /* [n][n] second derivative at point i of the spline that is 1 at point j */
} modal_spline;

void modal_spline_create(int n, const double *x, modal_spline *spline);

/* Weights at x, [n], and their derivatives, [n] or NULL. Outside the range the end pieces
 * continue. */
void modal_spline_weights(const modal_spline *spline, double x, double *weight, double *slope);

void modal_spline_free(modal_spline *spline); /* also on a zeroed struct */

#endif
