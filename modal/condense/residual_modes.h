/* Residual modes: Ritz modes of the part that the kept modes leave out, in the block Krylov space
 * of the residual terms. Free of PETSc.
 *
 * With P = I - phi phi^T M, the vectors V_0 = P K^-1 B, V_(i+1) = P K^-1 M V_i have the moments
 *
 *   mu_j = sum (B^T phi)(phi^T B)/lambda^j over the modes left out,
 *   V_i^T K V_j = mu_(i+j+1),   V_i^T M V_j = mu_(i+j+2).
 *
 * The Ritz problem of span{V_0 .. V_(q-1)} thus consists of block Hankel matrices:
 *
 *   [mu_(i+j+1)] y = theta [mu_(i+j+2)] y,   psi = sum_i (B^T V_i) y_i at the columns themselves.
 *
 * theta is at least the lowest lambda left out. sum psi psi^T/(theta - s) has the same mu_1 ..
 * mu_2q: its error in the receptance is of order s^2q and positive semi-definite. */
#ifndef MODAL_CONDENSE_RESIDUAL_MODES_H
#define MODAL_CONDENSE_RESIDUAL_MODES_H

#include "mesh/base/status.h"

enum { MODAL_RESIDUAL_BLOCKS = 3 }; /* q */

typedef struct {
  int     n;      /* modes, at most blocks times columns */
  double *lambda; /* [n] rad2/s2, ascending */
  double *weight; /* [blocks * columns][n] y: weights of the columns of V_0, V_1, V_2 */
} modal_residual_modes;

/* Solve the Ritz problem. moment[j]: mu_(j+1), [columns][columns], j < 2 blocks, made symmetric in
 * place. Directions whose mass is below 1e-12 of the largest are dropped. Errors: SHB_ERR_IO the
 * eigensolver failed. */
shb_status modal_residual_modes_create(int columns, double *const moment[2 * MODAL_RESIDUAL_BLOCKS],
                                       modal_residual_modes *ritz);
void       modal_residual_modes_free(modal_residual_modes *ritz); /* also on a zeroed struct */

/* Number of lowest modes to keep. The others, of shape psi [columns][n], change no receptance of a
 * column with itself at s < lambda[0] by more than tolerance times scale[column]. Only their part
 * outside the residual terms counts, psi^2 s^3/(lambda^3 (lambda - s)). */
int modal_residual_modes_needed(const modal_residual_modes *ritz, int columns, const double *psi,
                                const double *scale, double s, double tolerance);

#endif
