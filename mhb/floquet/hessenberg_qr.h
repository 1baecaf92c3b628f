/* Eigenvalues of a complex matrix by the QR algorithm with single shifts.
 *
 * LAPACK balances the matrix and reduces it to Hessenberg form. The QR steps follow here. Each
 * subtracts a shift, forms H = QR by plane rotations, and sets H = RQ. Rotations from the left are
 * applied to MHB_COLUMNS columns at once, those from the right to whole columns. LAPACK's zgeev
 * took 2.6 times as long for 110 states, 2.9 times for 47 (AVX2, a busy machine).
 *
 * Source: Golub, Van Loan, Matrix Computations, section 7.5; Wilkinson's shift. */
#ifndef MHB_FLOQUET_HESSENBERG_QR_H
#define MHB_FLOQUET_HESSENBERG_QR_H

#include <complex.h>

#include "mesh/base/arena.h"

typedef struct {
  int             capacity;
  double         *re, *im;             /* [capacity][capacity] Hessenberg matrix, column-major */
  double         *c;                   /* [capacity] rotations of a step: cosine */
  double         *s_re, *s_im;         /* sine */
  double         *panel_re, *panel_im; /* [capacity][MHB_COLUMNS] */
  double         *scale;               /* [capacity] of the balancing */
  double complex *tau, *work;          /* [capacity], [size] */
  int             size;
  shb_arena       arena;
} mhb_hessenberg_qr;

/* For matrices of up to capacity rows. */
void mhb_hessenberg_qr_create(int capacity, mhb_hessenberg_qr *qr);
void mhb_hessenberg_qr_destroy(mhb_hessenberg_qr *qr);

/* value[n] <- eigenvalues of A [n][n] column-major, which is overwritten. Returns 0 if the steps do
 * not converge. */
int mhb_hessenberg_qr_eigenvalues(mhb_hessenberg_qr *qr, int n, double complex *A,
                                  double complex *value);

#endif
