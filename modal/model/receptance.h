/* Receptance of the contact dofs of a modal model, for inspection and tests. Free of PETSc. */
#ifndef MODAL_MODEL_RECEPTANCE_H
#define MODAL_MODEL_RECEPTANCE_H

#include "modal/model/model.h"

/* Receptance of the contact dofs, including the modes left out (modal/model/residual_series.h):
 *
 *   r_pl(w) = sum_i phi_ip phi_il / (w_i^2 - w^2 + 2 j zeta_i w_i w) + residual terms and modes
 *
 *   omega       in   rad/s
 *   receptance  out  [n_contact][n_contact] m/N, in the order of the contact dofs
 *
 * Source: Chen, Yang, Menq 1999, eqs. 19-20, with residual terms and modes added. */
void modal_receptance(const modal_model *model, double omega, double complex *receptance);

/* Estimated error of the contact receptance by the modes left out, relative to its largest diagonal
 * value. It is -1 if the model lacks the data for it (modal_series_error). receptance:
 * modal_receptance at omega. */
double modal_receptance_error(const modal_model *model, double omega,
                              const double complex *receptance);

#endif
