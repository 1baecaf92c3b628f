/* Contribution of the modes left out, as a function of omega: residual terms R + a_1 R2 + a_2 R3
 * and residual modes.
 *
 * With s = omega^2, a mode of eigenvalue lambda that is left out contributes
 *
 *   1/(lambda - s) = 1/lambda + s/lambda^2 + s^2/lambda^3 + s^3/(lambda^3 (lambda - s)).
 *
 * R, R2, R3 hold the first three terms exactly. The residual modes (psi, theta) hold nearly all of
 * the last term (modal/condense/residual_modes.h):
 *
 *   H(s) = R + s R2 + s^2 R3 + sum psi psi^T s^3/(theta^3 (theta - s)).
 *
 * Above the first mode left out H is unknown and must stay bounded. Hence s is replaced by x = s/(1
 * + (s/c)^32)^(1/32) < c with c = 0.9 of the least theta. Up to 0.84 of that mode's frequency x
 * equals s to 1e-6.
 *
 * Without residual modes, x = s/(c + s) with c = (2 w_m)^2, w_m the last mode kept, bounds the
 * series:
 *
 *   1/(lambda - s) = 1/lambda + (c/lambda^2)(x + x^2) + (c^2/lambda^3) x^2 + O(x^3),
 *   a_1 = c (x + x^2) = s + O(s^3),   a_2 = c^2 x^2 = s^2 + O(s^3).
 *
 * Without R3, a_1 = s. */
#ifndef MODAL_MODEL_RESIDUAL_SERIES_H
#define MODAL_MODEL_RESIDUAL_SERIES_H

#include "modal/model/model.h"

enum { MODAL_TERMS = 3 }; /* R, R2, R3 */

typedef struct {
  double weight[MODAL_TERMS];      /* 1, a_1, a_2 of the contact; 0 without R3 */
  double slope[MODAL_TERMS];       /* d/ds of each */
  double load_weight[MODAL_TERMS]; /* the same of the load and the probes */
  double load_slope[MODAL_TERMS];
  double x, dx; /* of the residual modes; dx/ds */
} modal_series;

/* omega in rad/s. */
modal_series modal_series_at(const modal_model *model, double omega);

/* Weight x^3/(theta^3 (theta - x)) of residual mode i; slope: its derivative d/ds. */
double modal_series_mode(const modal_model *model, int i, const modal_series *series,
                         double *slope);

/* The same of all residual modes, into weight and slope [n_residual]. */
void modal_series_modes(const modal_model *model, const modal_series *series, double *weight,
                        double *slope);

/* True if the model holds R, R2 and R3, or has released some of them. R3 is used together with R
 * and R2 only. */
bool modal_series_has_fourth(const modal_model *model);

/* R, R2 or R3 (term 0, 1, 2) of a contact dof with itself; the model has all three. */
double modal_series_diagonal(const modal_model *model, int term, int dof);

/* Estimated error of the receptance of contact dof p with itself, m/N: the tail of the modes left
 * out plus the effect of x < s. It is at most R. It is -1 if the model has no tail. With the tail a
 * s^r + b s^(r+1) + ..., r = tail_order:
 *
 *   without residual modes  s^r a/(1 - s b/a): exact to two orders, a lower bound by Jensen's
 *                           inequality
 *   with residual modes     s^r a (1 - s/theta_1)^-p, p = theta_1 b/a: exact to two orders; the
 *                           remainder of Ritz modes has their poles
 *
 * The error matrix is positive semi-definite: the error between dofs p and l is at most the
 * geometric mean of their own errors. */
double modal_series_error(const modal_model *model, double omega, int dof);

#endif
