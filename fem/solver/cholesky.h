/* Sparse Cholesky factor on one rank, by CHOLMOD: supernodal, ordered by nested dissection of the nodes.
 *
 * The matrix is copied, permuted, only while a factor is being made; CHOLMOD's own copy is thereby avoided. Solves take
 * several right-hand sides at once: eight cost twice one. */
#ifndef FEM_SOLVER_CHOLESKY_H
#define FEM_SOLVER_CHOLESKY_H

#include <petscmat.h>
#include <stdbool.h>

typedef struct fem_cholesky fem_cholesky;

/* Order and analyse.
 *   A  in  sequential SBAIJ of block size 3; only its pattern is looked at
 *   fits  out  false: the factor would have 2^31 entries or more, which CHOLMOD cannot count; *out is then NULL */
PetscErrorCode fem_cholesky_create(Mat A, bool *fits, fem_cholesky **out);

/* Bytes of the factor, and of the work that making it takes beside. */
void fem_cholesky_bytes(const fem_cholesky *factor, double *factor_bytes, double *workspace);

/* Factorise A, whose pattern is that of _create; again after its values have changed. *definite false: it is not
 * positive definite, and there is no factor. PETSC_ERR_MEM. */
PetscErrorCode fem_cholesky_update(fem_cholesky *factor, Mat A, bool *definite);

/* A x = b for count columns; ld: entries from one column to the next. x may be b. */
PetscErrorCode fem_cholesky_solve(fem_cholesky *factor, int count, const double *b, size_t ldb,
                                  double *x, size_t ldx);

void fem_cholesky_destroy(fem_cholesky *factor); /* NULL: nothing */

#endif
