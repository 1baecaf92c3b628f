#include "mhb/numerics/lu.h"

#include <lapacke.h>

/* Up to this many unknowns LAPACK costs more in calls than in arithmetic. */
enum { SMALL = 6 };

static inline double complex times(double complex a, double complex b) {
  return CMPLX(creal(a) * creal(b) - cimag(a) * cimag(b),
               creal(a) * cimag(b) + cimag(a) * creal(b));
}

static inline double weight_of(double complex a) {
  return creal(a) * creal(a) + cimag(a) * cimag(a);
}

static void swap_rows(int n, double complex *A, int columns, int i, int j) {
  for (int c = 0; c < columns && i != j; c++) {
    double complex old = A[c * n + i];
    A[c * n + i]       = A[c * n + j];
    A[c * n + j]       = old;
  }
}

/* Gaussian elimination with row exchanges; the diagonal is kept inverted. */
static int factor_small(int n, double complex *A, int *pivot) {
  for (int j = 0; j < n; j++) {
    int best = j;
    for (int i = j + 1; i < n; i++)
      if (weight_of(A[j * n + i]) > weight_of(A[j * n + best])) best = i;
    double size = weight_of(A[j * n + best]);
    if (!(size > 0)) return 0;
    pivot[j] = best;
    swap_rows(n, A, n, j, best);
    A[j * n + j] = CMPLX(creal(A[j * n + j]) / size, -cimag(A[j * n + j]) / size);
    for (int i = j + 1; i < n; i++) A[j * n + i] = times(A[j * n + i], A[j * n + j]);
    for (int c = j + 1; c < n; c++)
      for (int i = j + 1; i < n; i++) A[c * n + i] -= times(A[j * n + i], A[c * n + j]);
  }
  return 1;
}

static void solve_small(int n, const double complex *A, const int *pivot, double complex *x) {
  for (int j = 0; j < n; j++) swap_rows(n, x, 1, j, pivot[j]);
  for (int j = 0; j < n; j++)
    for (int i = j + 1; i < n; i++) x[i] -= times(A[j * n + i], x[j]);
  for (int j = n - 1; j >= 0; j--) {
    x[j] = times(x[j], A[j * n + j]);
    for (int i = 0; i < j; i++) x[i] -= times(A[j * n + i], x[j]);
  }
}

int mhb_factor_complex(int n, double complex *A, int *pivot) {
  if (n <= SMALL) return factor_small(n, A, pivot);
  return LAPACKE_zgetrf_work(LAPACK_COL_MAJOR, n, n, A, n, pivot) == 0;
}

int mhb_solve_complex(int n, const double complex *A, const int *pivot, int columns,
                      double complex *x) {
  for (int c = 0; c < columns && n <= SMALL; c++) solve_small(n, A, pivot, x + c * n);
  return n <= SMALL ||
         LAPACKE_zgetrs_work(LAPACK_COL_MAJOR, 'N', n, columns, A, n, pivot, x, n) == 0;
}

/* The rows are columns of LAPACK: it factors the transpose and solves with the transpose of
 * that. */
int mhb_factor_real(int n, double *A, int *pivot) {
  return LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, A, n, pivot) == 0;
}

void mhb_solve_real(int n, const double *A, const int *pivot, double *x) {
  LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', n, 1, A, n, pivot, x, n);
}
