/* How many eigenvalues of K phi = lambda M phi lie below a number: by Sylvester's law as many as K - sigma M has negative pivots. */
#ifndef MODAL_EIGEN_INERTIA_COUNT_H
#define MODAL_EIGEN_INERTIA_COUNT_H

#include "fem/body/assemble.h"

/* Counted by an indefinite factorisation (MUMPS, with pivoting) whose factor is not kept: a quarter of its memory.
 *   sigma  rad2/s2, no eigenvalue
 * Collective. Errors: PETSC_ERR_USER_INPUT not enough memory; PETSC_ERR_MEM; PETSC_ERR_LIB it failed. */
PetscErrorCode modal_inertia_count(const fem_system *system, double sigma, int *count);

#endif
