#include "mhb/run_up/unitary.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

static void put(int width, double *x, int i, double complex value) {
  x[width * i] = creal(value);
  if (width == 2) x[2 * i + 1] = cimag(value);
}

static size_t square_of(int width, int m) {
  return (size_t)width * (size_t)m * (size_t)m;
}

/* ---- alignment ---- */

size_t mhb_unitary_align_work(int width, int m) {
  return 3 * square_of(width, m) + (size_t)m;
}

static int singular_values(int width, int m, double *X, double *sigma, double *A, double *B) {
  if (width == 1) return LAPACKE_dgesdd(LAPACK_ROW_MAJOR, 'A', m, m, X, m, sigma, A, m, B, m);
  return LAPACKE_zgesdd(LAPACK_ROW_MAJOR, 'A', m, m, (lapack_complex_double *)X, m, sigma,
                        (lapack_complex_double *)A, m, (lapack_complex_double *)B, m);
}

double mhb_unitary_align(int width, int m, int all, const double *re, const double *im,
                         double *work, double *V) {
  double *X = work, *A = X + square_of(width, m), *B = A + square_of(width, m);
  double *sigma = B + square_of(width, m);
  for (int i = 0; i < m; i++)
    for (int j = 0; j < m; j++)
      put(width, X, i * m + j, CMPLX(re[i * all + j], im ? im[i * all + j] : 0));
  if (singular_values(width, m, X, sigma, A, B) != 0) return -1; /* B is B^H by rows */
  for (int mode = 0; V && mode < m; mode++)
    for (int t = 0; t < m; t++) {
      double complex sum = 0;
      for (int k = 0; k < m; k++)
        sum += mhb_unitary_at(width, B, k * m + mode) * mhb_unitary_at(width, A, t * m + k);
      put(width, V, mode * m + t, conj(sum));
    }
  return sigma[m - 1];
}

void mhb_unitary_diagonal(int width, int m, const double *V, const double *value, double *out) {
  for (int t = 0; t < m; t++)
    for (int u = 0; u < m; u++) {
      double complex sum = 0;
      for (int i = 0; i < m; i++)
        sum += mhb_unitary_at(width, V, i * m + t) * value[i] *
               conj(mhb_unitary_at(width, V, i * m + u));
      put(width, out, t * m + u, sum); /* row u, column t */
    }
}

void mhb_unitary_form(int width, int m, const double *V, const double *re, const double *im,
                      double scale, double *out) {
  double complex column[m];
  for (int t = 0; t < m; t++) {
    for (int i = 0; i < m; i++) {
      column[i] = 0;
      for (int j = 0; j < m; j++)
        column[i] +=
            CMPLX(re[i * m + j], im ? im[i * m + j] : 0) * mhb_unitary_at(width, V, j * m + t);
    }
    for (int u = 0; u < m; u++) {
      double complex sum = 0;
      for (int i = 0; i < m; i++) sum += conj(mhb_unitary_at(width, V, i * m + u)) * column[i];
      put(width, out, t * m + u, scale * sum);
    }
  }
}

void mhb_unitary_row(int width, int m, const double *V, const double complex *row, double *out) {
  for (int t = 0; t < m; t++) {
    double complex sum = 0;
    for (int i = 0; i < m; i++) sum += row[i] * mhb_unitary_at(width, V, i * m + t);
    put(width, out, t, sum);
  }
}

/* ---- at a speed ---- */

void mhb_unitary_congruent(int width, int m, const double *U, const double *X, double *work,
                           double *out) {
  const double complex one = 1, zero = 0;
  if (width == 1) {
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, m, m, m, 1, X, m, U, m, 0, work, m);
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, m, m, m, 1, U, m, work, m, 0, out, m);
    return;
  }
  cblas_zgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, m, m, m, &one, X, m, U, m, &zero, work, m);
  cblas_zgemm(CblasColMajor, CblasConjTrans, CblasNoTrans, m, m, m, &one, U, m, work, m, &zero, out,
              m);
}

void mhb_unitary_rows(int width, int m, int rows, const double *U, const double *x, double *out) {
  const double complex one = 1, zero = 0;
  if (width == 1)
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, rows, m, m, 1, x, m, U, m, 0, out, m);
  else
    cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasTrans, rows, m, m, &one, x, m, U, m, &zero, out,
                m);
}

size_t mhb_unitary_modes_work(int width, int m) {
  return 3 * square_of(width, m) + 40 * (size_t)width * (size_t)m + 8;
}

/* K = R^H R, R = W Sigma V^H by Jacobi: K = V Sigma^2 V^H. 0: K is not positive definite. */
static int by_jacobi(int width, int m, const double *K, double *work, double *square, double *U) {
  double *A = work, *V = A + square_of(width, m), *sigma = V + square_of(width, m),
         *rest = sigma + m, *vectors = rest + 2 * m + 6;
  lapack_complex_double *A_z = (lapack_complex_double *)A;
  memcpy(A, K, square_of(width, m) * sizeof *A);
  if ((width == 1 ? LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'U', m, A, m)
                  : LAPACKE_zpotrf_work(LAPACK_COL_MAJOR, 'U', m, A_z, m)) != 0)
    return 0;
  for (int j = 0; j < m; j++)
    for (int i = j + 1; i < m; i++) put(width, A, j * m + i, 0);
  const int failed = width == 1 ? LAPACKE_dgesvj_work(LAPACK_COL_MAJOR, 'U', 'N', 'V', m, m, A, m,
                                                      sigma, 0, V, m, rest, 2 * m + 6)
                                : LAPACKE_zgesvj_work(LAPACK_COL_MAJOR, 'U', 'N', 'V', m, m, A_z, m,
                                                      sigma, 0, (lapack_complex_double *)V, m,
                                                      (lapack_complex_double *)vectors, 2 * m + 6,
                                                      rest, 2 * m + 6);
  if (failed != 0) return 0;
  for (int i = 0; i < m; i++) { /* falling */
    const int from = m - 1 - i;
    square[i]      = pow(rest[0] * sigma[from], 2);
    memcpy(U + width * i * m, V + width * from * m, (size_t)(width * m) * sizeof *U);
  }
  return 1;
}

/* The eigenvalues, to report by how much K is not positive definite. */
static void by_reduction(int width, int m, const double *K, double *work, double *square,
                         double *U) {
  memcpy(U, K, square_of(width, m) * sizeof *U);
  if (width == 1)
    LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'L', m, U, m, square, work, 3 * m * m + 39 * m);
  else
    LAPACKE_zheev_work(LAPACK_COL_MAJOR, 'V', 'L', m, (lapack_complex_double *)U, m, square,
                       (lapack_complex_double *)work, m * m + 19 * m, work + 2 * m * m + 38 * m);
}

void mhb_unitary_modes(int width, int m, const double *K, double *work, double *square, double *U) {
  if (!by_jacobi(width, m, K, work, square, U)) by_reduction(width, m, K, work, square, U);
}
