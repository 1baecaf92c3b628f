/* Residual modes: Ritz modes of what the kept modes leave out, in the block Krylov space that the residual terms are made from.
 *
 * With P = I - phi phi^T M, the vectors V_0 = P K^-1 B, V_(i+1) = P K^-1 M V_i and the moments
 *   mu_j = sum (B^T phi)(phi^T B)/lambda^j over the modes left out,  V_i^T K V_j = mu_(i+j+1),  V_i^T M V_j = mu_(i+j+2),
 * so that the Ritz problem of span{V_0 .. V_(q-1)} is (block Hankel matrices)
 *   [mu_(i+j+1)] y = theta [mu_(i+j+2)] y,   psi = sum_i (B^T V_i) y_i at the columns themselves, theta >= the least lambda left out.
 * sum psi psi^T/(theta - s) has the same mu_1 .. mu_2q: what it leaves out of the receptance is of order s^2q, and positive semi-definite.
 * Free of PETSc. */
#ifndef MODAL_CONDENSE_RESIDUAL_MODES_H
#define MODAL_CONDENSE_RESIDUAL_MODES_H

#include "mesh/base/status.h"

enum { MODAL_RESIDUAL_BLOCKS = 3 }; /* q */

typedef struct {
  int     n;      /* modes, at most blocks times columns */
  double *lambda; /* [n] rad2/s2, ascending */
  double *weight; /* [blocks * columns][n] y: what the mode takes of each column of V_0, V_1, V_2 */
} modal_residual_modes;

/* moment[j]: mu_(j+1), [columns][columns], j < 2 blocks; made symmetric. Directions of which less than 1e-12 is independent of the others
 * are left out. SHB_ERR_IO: no memory; the eigensolver failed. */
shb_status modal_residual_modes_create(int columns, double *const moment[2 * MODAL_RESIDUAL_BLOCKS],
                                       modal_residual_modes *ritz);
void       modal_residual_modes_free(modal_residual_modes *ritz); /* also on a zeroed struct */

/* Keep the lowest modes only: so many that those left out, shape psi [columns][n] of the modes, change no receptance of a column with itself at s
 * (below lambda[0]) by more than tolerance times scale[column] through the terms that no residual term holds, psi^2 s^3/(lambda^3 (lambda - s)). */
int modal_residual_modes_needed(const modal_residual_modes *ritz, int columns, const double *psi,
                                const double *scale, double s, double tolerance);

#endif
