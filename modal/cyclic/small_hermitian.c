#include "modal/cyclic/small_hermitian.h"

#include <lapacke.h>

bool small_hermitian_eigen(int n, double complex *A, double *value, bool vectors) {
  return LAPACKE_zheevd(LAPACK_COL_MAJOR, vectors ? 'V' : 'N', 'L', n, A, n, value) == 0;
}

bool small_hermitian_cholesky(int n, double complex *A) {
  return LAPACKE_zpotrf_work(LAPACK_COL_MAJOR, 'U', n, A, n) == 0;
}
