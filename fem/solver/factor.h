/* Factor of a symmetric positive definite matrix: choice of the program, and the memory it needs.
 *
 * On one rank: CHOLMOD (fem/solver/cholesky.h), whose solves are twice as fast as MUMPS's. On several
 * ranks, for a factor too large for CHOLMOD, or with the option -st_pc_factor_mat_solver_type mumps:
 * MUMPS, which takes the options -st_mat_mumps_.... */
#ifndef FEM_SOLVER_FACTOR_H
#define FEM_SOLVER_FACTOR_H

#include <petscksp.h>
#include <stdbool.h>

typedef struct fem_factor fem_factor;

/* Order and analyse the pattern of A. Collective, as all functions below.
 *   A       in  SBAIJ, block size 3
 *   beside  in  bytes that will be needed besides the factor, sum of all ranks
 * Errors: PETSC_ERR_USER_INPUT this machine lacks the memory; the text gives the bytes needed, the
 * bytes left and the remedy. */
PetscErrorCode fem_factor_create(Mat A, double beside, fem_factor **out);

/* Factorise A; again after its values have changed. *definite false: it is not positive definite; there may be no factor
 * then. PETSC_ERR_MEM. */
PetscErrorCode fem_factor_update(fem_factor *factor, Mat A, bool *definite);

/* A x = b; A X = B, all columns at once (dense matrices). */
PetscErrorCode fem_factor_solve(fem_factor *factor, Vec b, Vec x);
PetscErrorCode fem_factor_solve_many(fem_factor *factor, Mat B, Mat X);

/* Make pc apply the factor, one vector or many; the factor must outlive it. */
PetscErrorCode fem_factor_set_pc(fem_factor *factor, PC pc);

/* Bytes of the factor and of its making, all ranks, known from the analysis; who factorises. */
double      fem_factor_bytes(const fem_factor *factor);
const char *fem_factor_program(const fem_factor *factor);

PetscErrorCode fem_factor_destroy(fem_factor **factor); /* NULL: nothing */

#endif
