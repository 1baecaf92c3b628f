/* Receptance of the contact dofs of a modal model, and its samples in the file, for
 * readers, inspection and tests. Free of PETSc. */
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

/* Write /receptance/frequency [201 + m] Hz: even steps from 0 to 1.1 times the highest mode, and
 * the modes' own. Write /receptance/contact [201 + m][n_contact][n_contact], and error [201 + m].
 * Nothing is written above 64 MB. */
shb_status modal_receptance_write(hid_t file, const modal_model *model);

/* The same of a file that holds them, after a change of the damping. */
shb_status modal_receptance_replace(hid_t file, const modal_model *model);

#endif
