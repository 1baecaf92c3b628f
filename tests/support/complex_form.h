/* Complex harmonics of a signal in real form (mhb/numerics/fourier.h). */
#ifndef TESTS_SUPPORT_COMPLEX_FORM_H
#define TESTS_SUPPORT_COMPLEX_FORM_H

#include <complex.h>

/* A[m+1] <- a[2m+1] */
static inline void to_complex(int m, const double *a, double complex *A) {
  A[0] = a[0];
  for (int k = 1; k <= m; k++) A[k] = CMPLX(a[2 * k - 1], a[2 * k]);
}

#endif
