/* Sparse supernodal Cholesky factor on one rank, on all threads.
 *
 * CHOLMOD orders the nodes by nested dissection and analyses their pattern. Numbers and solves are
 * those of supernodal_factor and supernodal_solve.
 *
 * The matrix is not copied. The numbers do not depend on the number of threads. A solve takes
 * several right-hand sides: eight cost twice as much as one. */
#ifndef FEM_SOLVER_CHOLESKY_H
#define FEM_SOLVER_CHOLESKY_H

#include <petscmat.h>
#include <stdbool.h>

#include "fem/supernodal/unit_loads.h"

typedef struct fem_cholesky fem_cholesky;

/* Order and analyse the pattern of A.
 *   A    in   sequential SBAIJ of block size 3
 *   out  out  NULL: counted by nodes, the factor would have 2^31 entries or more, which CHOLMOD
 *             cannot index */
PetscErrorCode fem_cholesky_create(Mat A, fem_cholesky **out);

/* Bytes of the factor, and of the workspace of the factorisation. */
void fem_cholesky_bytes(const fem_cholesky *factor, double *factor_bytes, double *workspace);

/* Factorise A, which has the pattern of _create; may be repeated after its values have changed.
 *   definite  out  false: A is not positive definite, and there is no factor */
PetscErrorCode fem_cholesky_update(fem_cholesky *factor, Mat A, bool *definite);

/* Solve A x = b for count columns; x may be b.
 *   ldb, ldx  in  entries from one column to the next */
void fem_cholesky_solve(fem_cholesky *factor, int count, const double *b, size_t ldb, double *x,
                        size_t ldx);

/* The same where only the rows of some nodes are wanted. Such a solution reads little of the factor
 * on its way back.
 *   node  in   [block rows of A] true: wanted; the other rows of x mean nothing */
void fem_cholesky_solve_at(fem_cholesky *factor, const bool *node, int count, const double *b,
                           size_t ldb, double *x, size_t ldx);

/* The numbers and their order, until the next update. */
fem_tree fem_cholesky_tree(const fem_cholesky *factor);

void fem_cholesky_destroy(fem_cholesky *factor); /* NULL: nothing */

#endif
