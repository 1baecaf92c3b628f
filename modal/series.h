/* Weights of the residual terms of the contact in its receptance, R + alpha R2 + beta R3.
 *
 * R3, the coefficient of omega^4, would make the plain series grow without bound at high harmonics, above the modes left
 * out. With x = omega^2/(c + omega^2), c = (2 w_m)^2, w_m the last mode kept, the same series is
 *   1/(lambda - omega^2) = 1/lambda + (c/lambda^2)(x + x^2) + (c^2/lambda^3) x^2 + O(x^3):
 *   alpha = c (x + x^2) = omega^2 + O(omega^6),   beta = c^2 x^2 = omega^4 + O(omega^6),
 * which stays bounded. Without R3, alpha = omega^2. */
#ifndef MODAL_SERIES_H
#define MODAL_SERIES_H

#include "modal/model.h"

enum { MODAL_TERMS = 3, MODAL_MOMENTS = 5 }; /* R, R2, R3; mu_1 .. mu_5 */

typedef struct {
  double weight[MODAL_TERMS]; /* 1, alpha s^-2, beta s^-4; beta is 0 without R3 */
  double slope[MODAL_TERMS];  /* d/d(omega^2) of each */
} modal_series;

/* omega in rad/s. */
modal_series modal_series_at(const modal_model *model, double omega);

/* Whether the model holds R3: it counts beside R and R2 only. */
bool modal_series_has_fourth(const modal_model *model);

/* What R + alpha R2 + beta R3 leaves out of the receptance of contact dof p with itself, m/N; no receptance between contact dofs lacks
 * more than the greatest of these. With mu_j = sum phi_p^2/lambda^j over the modes left out, s = omega^2, exactly
 *   sum phi^2/(lambda - s) - R - alpha R2 - beta R3 = s^3 sum phi^2/(lambda^3 (lambda - s)) + (s - alpha) mu_2 + (s^2 - beta) mu_3,
 * and the sum is mu_4/(1 - s mu_5/mu_4) for one mode in the place of all, of the same mu_4 and mu_5: exact to O(s^5), and below the first
 * mode left out never too great (Jensen's inequality). Not more than R: where the series means nothing that is all there is to go by.
 * -1 if the model does not hold the moments. */
double modal_series_error(const modal_model *model, double omega, int dof);

/* The same from moments mu_1 .. mu_5; last: the last mode kept, rad/s. */
double modal_series_left(const double moment[MODAL_MOMENTS], double omega, double last);

/* mu_1 .. mu_5 of a contact dof; the model must hold them all. */
void modal_series_moments(const modal_model *model, int dof, double moment[MODAL_MOMENTS]);

#endif
