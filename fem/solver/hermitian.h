/* Sparse Hermitian Cholesky factor L L^H of 3x3 blocks on one thread by CHOLMOD. One symbolic
 * analysis serves any number of factors, also on several threads. Free of PETSc. */
#ifndef FEM_SOLVER_HERMITIAN_H
#define FEM_SOLVER_HERMITIAN_H

#include <complex.h>

#include "fem/solver/block_order.h"
#include "mesh/base/status.h"

typedef struct fem_hermitian_order fem_hermitian_order;
typedef struct fem_hermitian       fem_hermitian;

/* Order and analyse a pattern, which must outlive the order and its factors. Errors: SHB_ERR_IO no
 * memory; SHB_ERR_INPUT the factor has 2^31 entries or more. */
shb_status fem_hermitian_analyse(const fem_blocks *pattern, fem_hermitian_order **out);
void       fem_hermitian_order_free(fem_hermitian_order *order); /* NULL: nothing */

/* Bytes of one factor with the workspace of its making. */
double fem_hermitian_bytes(const fem_hermitian_order *order);

/* Factorise.
 *   value     in   [block][9] upper triangle in the order of the pattern, each block by columns
 *   definite  out  false: not positive definite, and *out is NULL
 * Errors: SHB_ERR_IO no memory. */
shb_status fem_hermitian_create(const fem_hermitian_order *order, const double complex *value,
                                bool *definite, fem_hermitian **out);

/* Solve A x = b for count columns [3 n]; x may be b. Errors: SHB_ERR_IO no memory. */
shb_status fem_hermitian_solve(fem_hermitian *factor, int count, const double complex *b,
                               double complex *x);

void fem_hermitian_free(fem_hermitian *factor); /* NULL: nothing */

#endif
