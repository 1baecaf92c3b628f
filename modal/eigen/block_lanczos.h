/* Block Lanczos as an eigensolver of SLEPc: EPS type MODAL_BLOCK_LANCZOS, for EPS_GHEP with shift-and-invert.
 *
 * From a fixed, structureless start block X the space span{X, T X, T^2 X, ...}, T = (K - shift M)^-1 M, grows by one block
 * a step, orthonormal in M with full reorthogonalisation and without restarts, until the wanted Ritz pairs have
 * |T x - theta x| <= tolerance theta. A block is solved at once, which costs a third of its columns one by one; a mode that
 * is repeated up to as many times as the block has columns is found as often. Every mode of X's span has a part in all
 * directions, so modes come in order; yet nothing in exact arithmetic shows more copies than the block has columns.
 *
 * -eps_ncv: columns at which to give up; -eps_block_size. Source: Golub, Underwood, The block Lanczos method, 1977. */
#ifndef MODAL_EIGEN_BLOCK_LANCZOS_H
#define MODAL_EIGEN_BLOCK_LANCZOS_H

#include <slepceps.h>

#include "modal/eigen/block_basis.h"

#define MODAL_BLOCK_LANCZOS "block_lanczos"

/* Make the type known to SLEPc; again does no harm. */
PetscErrorCode modal_block_lanczos_register(void);

/* Columns a block; eps is of this type. */
PetscErrorCode modal_block_lanczos_set_size(EPS eps, PetscInt size);
PetscErrorCode modal_block_lanczos_get_size(EPS eps, PetscInt *size);

/* The basis of the last run, which modal/eigen/missed_modes.h asks for; freed by _release, or with eps. */
PetscErrorCode modal_block_lanczos_basis(EPS eps, const modal_block_basis **basis);
PetscErrorCode modal_block_lanczos_release(EPS eps);

#endif
