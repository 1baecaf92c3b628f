/* Small matrices of a space of modes, real or complex.
 *
 * width 1: numbers are real. width 2: complex, as pairs (re, im); then the matrices of a travelling
 * wave. m: modes kept. Square matrices of K and Z are stored by columns, V [mode][place] and all
 * other arrays by rows. */
#ifndef MHB_RUN_UP_UNITARY_H
#define MHB_RUN_UP_UNITARY_H

#include <complex.h>
#include <stddef.h>

/* Doubles of scratch that align needs: of m modes kept of all. */
size_t mhb_unitary_align_work(int width, int m);

/* Orthogonal or unitary Procrustes. Of the leading m x m block of an overlap, A Sigma B^H, returns
 * the least Sigma (-1: not found), and V = B A^H unless NULL.
 *
 *   re, im  in  [all][all] overlap of the first speed's modes with those of this one; im: of width
 *               2 only */
double mhb_unitary_align(int width, int m, int all, const double *re, const double *im,
                         double *work, double *V);

/* out[m][m] = V^H diag(value) V */
void mhb_unitary_diagonal(int width, int m, const double *V, const double *value, double *out);

/* out[m][m] = scale V^H X V, by columns.
 *   re, im  in  [m][m] X by rows; im NULL: real */
void mhb_unitary_form(int width, int m, const double *V, const double *re, const double *im,
                      double scale, double *out);

/* out[m] = row[m] V; a real row where width is 1. */
void mhb_unitary_row(int width, int m, const double *V, const double complex *row, double *out);

/* out[m][m] = U^H X U, X by columns, eigenvector i of U in row i; work: width m^2. */
void mhb_unitary_congruent(int width, int m, const double *U, const double *X, double *work,
                           double *out);

/* out[rows][m] = x[rows][m] U, eigenvector i of U in row i. */
void mhb_unitary_rows(int width, int m, int rows, const double *U, const double *x, double *out);

/* Eigenvectors and eigenvalues of K, ascending. The entries of K differ by orders of magnitude, so
 * one-sided Jacobi works on its Cholesky factor (Demmel and Veselic 1992). It gives the low
 * eigenvalues to their own rounding, not to that of the highest. Where K is not positive definite
 * some are negative, and all are to that of the highest.
 *
 *   U       out  [m][m] eigenvector i in row i
 *   square  out  [m]
 *   work    mhb_unitary_modes_work doubles */
void mhb_unitary_modes(int width, int m, const double *K, double *work, double *square, double *U);
size_t mhb_unitary_modes_work(int width, int m);

/* Entry i of an array, a number of width doubles. */
static inline double complex mhb_unitary_at(int width, const double *x, int i) {
  return width == 1 ? CMPLX(x[i], 0) : CMPLX(x[2 * i], x[2 * i + 1]);
}

#endif
