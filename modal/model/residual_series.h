/* What the modes left out answer, as a function of omega: residual terms R + a_1 R2 + a_2 R3 and residual modes.
 *
 * With s = omega^2, a mode of eigenvalue lambda that is left out answers 1/(lambda - s) = 1/lambda + s/lambda^2 + s^2/lambda^3 +
 * s^3/(lambda^3 (lambda - s)). R, R2, R3 hold the first three, exactly. Of the last the residual modes (psi, theta; modal/condense/residual_modes.h) hold nearly all:
 *   H(s) = R + s R2 + s^2 R3 + sum psi psi^T s^3/(theta^3 (theta - s))
 * Above the modes left out all of it is unknown, and must stay bounded: s is taken as x = s/(1 + (s/c)^32)^(1/32) < c, c = .9 of the least theta,
 * which is s but for 1e-6 of it up to .84 of that mode's frequency.
 *
 * A model without residual modes: with x = s/(c + s), c = (2 w_m)^2, w_m the last mode kept, the series is
 *   1/(lambda - s) = 1/lambda + (c/lambda^2)(x + x^2) + (c^2/lambda^3) x^2 + O(x^3):
 *   a_1 = c (x + x^2) = s + O(s^3),   a_2 = c^2 x^2 = s^2 + O(s^3),
 * bounded as well. Without R3, a_1 = s. */
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

/* Weight x^3/(theta^3 (theta - x)) of residual mode i, and its d/ds. */
double modal_series_mode(const modal_model *model, int i, const modal_series *series,
                         double *slope);

/* Whether the model holds R3: it counts beside R and R2 only. */
bool modal_series_has_fourth(const modal_model *model);

/* Estimated error of the receptance of contact dof p with itself by the modes left out, m/N: their tail, a s^r and its growth, r the model's
 * tail_order, and what s - x adds. Not more than R: where the series means nothing that is all there is to go by. -1 if the model does not hold
 * the tail.
 *   without residual modes  s^r a/(1 - s b/a): one mode in the place of all, exact to two orders and never too great (Jensen's inequality)
 *   with them               s^r a (1 - s/theta_1)^-p, p = theta_1 b/a: exact to two orders; what Ritz modes miss has their poles too
 * The error matrix is positive semi-definite: no receptance between dofs p and l lacks more than the geometric mean of theirs. */
double modal_series_error(const modal_model *model, double omega, int dof);

#endif
