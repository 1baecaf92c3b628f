/* Sparse Hermitian Cholesky factor L L^H of 3x3 blocks at any theta. Free of PETSc.
 *
 * Ordered and analysed by CHOLMOD once. What does not depend on theta
 * (fem/supernodal/panel_turns.h) is factorised once, on all threads. The rest takes one thread:
 * several theta may be factorised and solved at a time. */
#ifndef FEM_SOLVER_HERMITIAN_H
#define FEM_SOLVER_HERMITIAN_H

#include <complex.h>

#include "fem/supernodal/block_order.h"
#include "fem/supernodal/panel_turns.h"
#include "mesh/base/status.h"

/* A(theta): upper triangle, each block by columns. */
typedef struct {
  fem_blocks         pattern;
  const double      *real;      /* [block][9] R */
  int                n_coupled; /* blocks that are not R at every theta */
  const int         *coupled;   /* [n_coupled] */
  const signed char *exponent;  /* [n_coupled] e where the block is e^(j theta e) R */
} fem_hermitian_matrix;

typedef struct fem_hermitian_order fem_hermitian_order;
typedef struct fem_hermitian       fem_hermitian;

/* Order, analyse, and factorise what is real. The arrays of A must outlive the order. Errors:
 * SHB_ERR_INPUT the machine has too little memory, or the factor cannot be indexed. */
shb_status fem_hermitian_analyse(const fem_hermitian_matrix *A, fem_hermitian_order **out);
void       fem_hermitian_order_free(fem_hermitian_order *order); /* NULL: nothing */

/* Bytes of the factor of one theta with the workspace of its making, beside the real part. */
double fem_hermitian_bytes(const fem_hermitian_order *order);

/* Factorise. Returns NULL where A is not positive definite.
 *   turn   in  e^(j theta)
 *   value  in  [n_coupled][9] the coupled blocks at theta */
fem_hermitian *fem_hermitian_create(const fem_hermitian_order *order, double complex turn,
                                    const double complex (*value)[9]);

/* Solve A x = b for count columns [3 n]; x may be b. */
void fem_hermitian_solve(fem_hermitian *factor, int count, const double complex *b,
                         double complex *x);

void fem_hermitian_free(fem_hermitian *factor); /* NULL: nothing */

#endif
