/* Small dense linear systems: a few unknowns in place, more by LAPACK. No allocation. */
#ifndef MHB_NUMERICS_LU_H
#define MHB_NUMERICS_LU_H

#include <complex.h>

/* Complex, column-major: the systems of one harmonic.
 * A[n][n] <- its factors, pivot[n]. 0: singular. */
int mhb_factor_complex(int n, double complex *A, int *pivot);

/* x[columns][n] <- A^-1 x, A as factored. 0: failed. */
int mhb_solve_complex(int n, const double complex *A, const int *pivot, int columns,
                      double complex *x);

/* Real, row-major. A[n][n] <- its factors, pivot[n]. 0: singular. */
int mhb_factor_real(int n, double *A, int *pivot);

/* x[n] <- A^-1 x, A as factored. */
void mhb_solve_real(int n, const double *A, const int *pivot, double *x);

#endif
