/* Receptance of the contact dofs of a modal model, for inspection and tests. Free of PETSc. */
#ifndef MODAL_MODEL_RECEPTANCE_H
#define MODAL_MODEL_RECEPTANCE_H

#include "modal/model/model.h"

/* r_pl(w) = sum_i phi_ip phi_il / (w_i^2 - w^2 + 2 j zeta_i w_i w) + what the modes left out answer (modal/model/residual_series.h).
 *   omega       in   rad/s
 *   receptance  out  [n_contact][n_contact] m/N, order of the contact dofs
 * Source: Chen, Yang, Menq 1999, eqs. 19-20; plus the residual terms and modes. */
void modal_receptance(const modal_model *model, double omega, double complex *receptance);

/* Estimated error of the greatest receptance of a contact dof with itself, relative to it, by the modes left out; -1 if the model does not
 * hold what it takes (modal_series_error). receptance: as modal_receptance gives it at omega. */
double modal_receptance_error(const modal_model *model, double omega,
                              const double complex *receptance);

#endif
