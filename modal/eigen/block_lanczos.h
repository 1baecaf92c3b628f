/* Block Lanczos as an eigensolver of SLEPc: EPS type MODAL_BLOCK_LANCZOS, for EPS_GHEP with
 * shift-and-invert.
 *
 * With T = (K - shift M)^-1 M the Krylov space is span{X, T X, T^2 X, ...}. It starts from a fixed
 * random block X and grows by one block a step. The basis is M-orthonormal with full
 * reorthogonalisation and without restarts. The run ends when all wanted Ritz pairs satisfy |T x -
 * theta x| <= tolerance theta.
 *
 * Solving for a block takes about a third of the time of its columns one by one. Modes converge in
 * order, since X has a component along every mode. In exact arithmetic a repeated mode is found as
 * often as the block has columns, at most.
 *
 * -eps_ncv: columns at which the solver gives up; -eps_block_size: columns per block. Source:
 * Golub, Underwood, The block Lanczos method, 1977. */
#ifndef MODAL_EIGEN_BLOCK_LANCZOS_H
#define MODAL_EIGEN_BLOCK_LANCZOS_H

#include <slepceps.h>

#include "modal/eigen/block_basis.h"

#define MODAL_BLOCK_LANCZOS "block_lanczos"

/* Register the type with SLEPc; repeated calls are harmless. */
PetscErrorCode modal_block_lanczos_register(void);

/* Columns per block; eps is of this type. */
PetscErrorCode modal_block_lanczos_set_size(EPS eps, PetscInt size);
PetscErrorCode modal_block_lanczos_get_size(EPS eps, PetscInt *size);

/* Basis of the last run, for modal/eigen/missed_modes.h. Freed by _release or with eps. */
PetscErrorCode modal_block_lanczos_basis(EPS eps, const modal_block_basis **basis);
PetscErrorCode modal_block_lanczos_release(EPS eps);

#endif
