/* Complex linear systems of a harmonic: a few unknowns in place, more by LAPACK. Column-major. No allocation. */
#ifndef MHB_NUMERICS_LU_H
#define MHB_NUMERICS_LU_H

#include <complex.h>

/* A[n][n] <- its factors, pivot[n]. 0: singular. */
int mhb_factor_complex(int n, double complex *A, int *pivot);

/* x[columns][n] <- A^-1 x, A as factored. 0: failed. */
int mhb_solve_complex(int n, const double complex *A, const int *pivot, int columns,
                      double complex *x);

#endif
