/* The lower triangle of a symmetric matrix as blocks of columns, for BLAS: half of the memory.
 * Free of PETSc. */
#ifndef FEM_SUPERNODAL_LOWER_BLOCKS_H
#define FEM_SUPERNODAL_LOWER_BLOCKS_H

#include <stddef.h>

/* Rows and columns from skip on of a matrix of order n. */
typedef struct {
  double *at;
  int     n, skip;
} fem_lower;

/* Numbers that a matrix of order n takes. */
size_t fem_lower_numbers(int n);

/* Column j: entry [i] is that of row i >= j; both count from skip. */
double *fem_lower_column(const fem_lower *Q, int j);

/* Q += (E^T Z + Z^T E) / 2, on all threads.
 *   E, Z  in  [k][n - skip] */
void fem_lower_add_products(const fem_lower *Q, int k, const double *E, const double *Z);

/* y = Q x.
 *   x, y  [n - skip][count] */
void fem_lower_multiply(const fem_lower *Q, int count, const double *x, double *y);

#endif
