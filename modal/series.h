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

enum { MODAL_TERMS = 3 }; /* R, R2, R3 */

typedef struct {
  double weight[MODAL_TERMS]; /* 1, alpha s^-2, beta s^-4; beta is 0 without R3 */
  double slope[MODAL_TERMS];  /* d/d(omega^2) of each */
} modal_series;

/* omega in rad/s. */
modal_series modal_series_at(const modal_model *model, double omega);

/* Whether the model holds R3: it counts beside R and R2 only. */
bool modal_series_has_fourth(const modal_model *model);

#endif
