#include "mhb/numerics/lu.h"

#include <lapacke.h>
#include <math.h>

/* Up to this many unknowns, complex and real, LAPACK costs more in calls than in arithmetic. */
enum { SMALL = 6, SMALL_REAL = 12 };

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

static int factor_small_real(int n, double *A, int *pivot) {
  for (int j = 0; j < n; j++) {
    int best = j;
    for (int i = j + 1; i < n; i++)
      if (fabs(A[i * n + j]) > fabs(A[best * n + j])) best = i;
    if (!(fabs(A[best * n + j]) > 0)) return 0;
    pivot[j] = best;
    for (int c = 0; c < n && best != j; c++) {
      double old      = A[j * n + c];
      A[j * n + c]    = A[best * n + c];
      A[best * n + c] = old;
    }
    A[j * n + j] = 1 / A[j * n + j];
    for (int i = j + 1; i < n; i++) {
      double part = A[i * n + j] *= A[j * n + j];
      for (int c = j + 1; c < n; c++) A[i * n + c] -= part * A[j * n + c];
    }
  }
  return 1;
}

static void solve_small_real(int n, const double *A, const int *pivot, double *x) {
  for (int j = 0; j < n; j++) {
    double old  = x[j];
    x[j]        = x[pivot[j]];
    x[pivot[j]] = old;
  }
  for (int i = 1; i < n; i++)
    for (int j = 0; j < i; j++) x[i] -= A[i * n + j] * x[j];
  for (int i = n - 1; i >= 0; i--) {
    for (int j = i + 1; j < n; j++) x[i] -= A[i * n + j] * x[j];
    x[i] *= A[i * n + i];
  }
}

/* The rows are columns of LAPACK: it factors the transpose and solves with the transpose of
 * that. */
int mhb_factor_real(int n, double *A, int *pivot) {
  if (n <= SMALL_REAL) return factor_small_real(n, A, pivot);
  return LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, A, n, pivot) == 0;
}

void mhb_solve_real(int n, const double *A, const int *pivot, double *x) {
  if (n <= SMALL_REAL)
    solve_small_real(n, A, pivot, x);
  else
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', n, 1, A, n, pivot, x, n);
}
