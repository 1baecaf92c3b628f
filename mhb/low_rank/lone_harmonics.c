#include "mhb/low_rank/lone_harmonics.h"

#include <cblas.h>
#include <lapacke.h>
#include <string.h>

/* to[3][2] <- D x of a pair; x[3][stride], real and imaginary part side by side. */
static void pair_force(const double complex D[9], const double *x, int stride, double to[6]) {
  for (int c = 0; c < 3; c++) {
    double re = 0, im = 0;
    for (int d = 0; d < 3; d++) {
      const double a = creal(D[3 * c + d]), b = cimag(D[3 * c + d]), *u = x + d * stride;
      re += a * u[0] - b * u[1];
      im += b * u[0] + a * u[1];
    }
    to[2 * c]     = re;
    to[2 * c + 1] = im;
  }
}

/* T[wide][wide] <- X^H D X of harmonic k. */
static void set_T(const mhb_woodbury *w, int k, const double complex (*D)[9], double *T) {
  const int wide = 2 * w->basis->rank[k];
  memset(T, 0, sizeof(double) * (size_t)wide * (size_t)wide);
  for (int a = 0; a < w->n_pairs; a++) {
    const double *X = w->basis->X[k] + (size_t)(6 * a) * (size_t)wide;
    double        column[6], DX[6];
    for (int j = 0; j < wide; j++) {
      for (int i = 0; i < 6; i++) column[i] = X[i * wide + j];
      pair_force(D[a], column, 2, DX);
      for (int i = 0; i < wide; i++)
        for (int l = 0; l < 6; l++) T[i * wide + j] += X[l * wide + i] * DX[l];
    }
  }
}

/* The factors of harmonic k lie in G[wide][wide] from the square of the first coefficient on. */
static double *factors_of(const mhb_woodbury *w, int k) {
  return w->G + (size_t)w->basis->first[k] * (size_t)w->basis->size;
}

int mhb_lone_harmonics_factor(mhb_woodbury *w, const mhb_law *law, int first,
                              const double complex (*D)[9]) {
  if (!mhb_woodbury_prepare(w, law)) return 0;
  for (int k = first; k <= w->m; k++) {
    const int wide = 2 * w->basis->rank[k];
    double   *G    = factors_of(w, k);
    if (wide == 0) continue;
    set_T(w, k, D, w->T);
    memset(G, 0, sizeof(double) * (size_t)wide * (size_t)wide);
    for (int i = 0; i < wide; i++) G[i * wide + i] = 1;
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, wide, wide, wide, 1, w->T, wide,
                w->basis->K[k], wide, 1, G, wide);
    if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, wide, wide, G, wide, w->pivot + w->basis->first[k]))
      return 0;
  }
  return 1;
}

void mhb_lone_harmonics_solve(const mhb_woodbury *w, int first, const double complex (*D)[9],
                              double *x) {
  const mhb_contact_basis *b  = w->basis;
  const int                nb = w->nb;
  for (int k = first; k <= w->m; k++) {
    const int wide = 2 * b->rank[k], at = 2 * k - 1;
    double   *y = w->y + b->first[k], *Ky = w->Ky + b->first[k];
    if (wide == 0) continue;
    for (int a = 0; a < w->n_pairs; a++) pair_force(D[a], x + 3 * a * nb + at, nb, w->part + 6 * a);
    cblas_dgemv(CblasRowMajor, CblasTrans, 2 * w->n3, wide, 1, b->X[k], wide, w->part, 1, 0, y, 1);
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', wide, 1, factors_of(w, k), wide,
                        w->pivot + b->first[k], y, wide);
    cblas_dgemv(CblasRowMajor, CblasNoTrans, wide, wide, 1, b->K[k], wide, y, 1, 0, Ky, 1);
    cblas_dgemv(CblasRowMajor, CblasNoTrans, 2 * w->n3, wide, 1, b->X[k], wide, Ky, 1, 0, w->part,
                1);
    for (int i = 0; i < w->n3; i++)
      for (int p = 0; p < 2; p++) x[i * nb + at + p] -= w->part[2 * i + p];
  }
}
