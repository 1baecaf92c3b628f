/* Small dense Hermitian matrices, [n][n] by columns. Apart from LAPACK's headers, which PETSc's
 * contradict. */
#ifndef MODAL_CYCLIC_SMALL_HERMITIAN_H
#define MODAL_CYCLIC_SMALL_HERMITIAN_H

#include <complex.h>
#include <stdbool.h>

/* Eigenvalues of the lower triangle A, ascending; with vectors they replace A. Returns false if
 * they were not found. */
bool small_hermitian_eigen(int n, double complex *A, double *value, bool vectors);

/* Upper triangle R with A = R^H R. Returns false if A is not positive definite. */
bool small_hermitian_cholesky(int n, double complex *A);

#endif
