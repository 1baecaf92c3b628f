/* Coriolis matrix of the modes of a clamped blade, or of a sector at nodal diameter 0.
 *
 * G is the mass matrix with 2 Omega [e]x in place of the identity. So G phi follows from M phi row
 * by row. Derivation: docs/theory/coriolis.md. */
#ifndef MODAL_EIGEN_CORIOLIS_H
#define MODAL_EIGEN_CORIOLIS_H

#include "fem/body/rotation.h"
#include "modal/eigen/eigen.h"

/* matrix [n][n] <- phi^T G phi of the first n modes, 1/s, skew-symmetric. Collective; every rank
 * gets it. Errors: PETSC_ERR_MEM. */
PetscErrorCode modal_coriolis(const modal_eigen *eigen, const fem_rotation *rotation,
                              fem_turning turning, double *matrix);

#endif
