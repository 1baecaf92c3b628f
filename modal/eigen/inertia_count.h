/* Number of eigenvalues of K phi = lambda M phi below sigma: the negative pivots of K - sigma M
 * (Sylvester's law of inertia). */
#ifndef MODAL_EIGEN_INERTIA_COUNT_H
#define MODAL_EIGEN_INERTIA_COUNT_H

#include "fem/body/assemble.h"

/* Count by an indefinite factorisation (MUMPS, with pivoting). The factor is discarded, which needs
 * a quarter of its memory.
 *
 *   sigma  rad2/s2, not an eigenvalue
 *
 * Collective. Errors: PETSC_ERR_USER_INPUT too little memory; PETSC_ERR_MEM; PETSC_ERR_LIB the
 * factorisation failed. */
PetscErrorCode modal_inertia_count(const fem_system *system, double sigma, int *count);

#endif
