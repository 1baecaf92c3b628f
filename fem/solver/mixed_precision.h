/* Where a Cholesky factor in double precision does not fit: one in single precision (SMUMPS) on one rank, of about half its size, and conjugate
 * gradients in double precision with it, which make up for the digits: each iteration gains about two of them.
 *
 * A solution is taken when its residual in the norm of the preconditioner, (r^T z)^1/2, has fallen by 1e-13, or when it falls no more below 1e-10. */
#ifndef FEM_SOLVER_MIXED_PRECISION_H
#define FEM_SOLVER_MIXED_PRECISION_H

#include <petscmat.h>
#include <stdbool.h>

typedef struct fem_single fem_single;

/* Order and analyse the pattern of A (sequential SBAIJ, block size 3). PETSC_ERR_MEM. */
PetscErrorCode fem_single_create(Mat A, fem_single **out);

/* Bytes of the factor and of its making, from the analysis. */
double fem_single_foreseen(const fem_single *factor);

/* Factorise A, and keep it for the iterations. *definite false: it is not positive definite, as far as single precision can tell. PETSC_ERR_MEM. */
PetscErrorCode fem_single_update(fem_single *factor, Mat A, bool *definite);

/* A x = b for count columns; ld: entries from one column to the next. x may be b. Errors: PETSC_ERR_NOT_CONVERGED (A is not positive definite, or too
 * far from its rounded factor). */
PetscErrorCode fem_single_solve(fem_single *factor, int count, const double *b, size_t ldb,
                                double *x, size_t ldx);

PetscErrorCode fem_single_destroy(fem_single **factor); /* NULL: nothing */

#endif
