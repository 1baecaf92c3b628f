#include "mhb/structure/gyroscopic.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

static shb_status allocate(int n, mhb_gyroscopic *out) {
  const size_t m = (size_t)n;
  *out           = (mhb_gyroscopic){.n     = n,
                                    .omega = malloc((2 * m + 1) * sizeof *out->omega),
                                    .decay = malloc((2 * m + 1) * sizeof *out->decay),
                                    .shape = malloc((2 * m * m + 1) * sizeof *out->shape)};
  SHB_CHECK(out->omega && out->decay && out->shape, SHB_ERR_IO,
            "out of memory for %d gyroscopic modes", n);
  return SHB_OK;
}

/* A[2n][2n] <- [0, L^H; L, j G], lower triangle by columns; L by columns. */
static void assemble(int n, const double complex *L, const double complex *G, double complex *A) {
  const size_t m = (size_t)n, all = 2 * m;
  memset(A, 0, all * all * sizeof *A);
  for (size_t j = 0; j < m; j++)
    for (size_t i = j; i < m; i++) {
      A[j * all + m + i]       = L[j * m + i];
      A[(m + j) * all + m + i] = I * G[i * m + j];
    }
}

/* Shapes and decay rates from the eigenvectors y, by columns. */
static void take_modes(const double complex *y, const double *loss, mhb_gyroscopic *out) {
  const size_t n = (size_t)out->n;
  for (size_t k = 0; k < 2 * n; k++) {
    out->decay[k] = 0;
    for (size_t i = 0; i < n; i++) {
      const double complex v = y[k * 2 * n + n + i]; /* w x */
      out->shape[k * n + i]  = v / out->omega[k];
      out->decay[k] += loss[i] * (creal(v) * creal(v) + cimag(v) * cimag(v));
    }
  }
}

/* L of K = L L^H by columns, from K by rows; upper triangle zero. */
static bool factor(int n, const double complex *K, double complex *L) {
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) L[j * n + i] = i >= j ? K[i * n + j] : 0;
  return LAPACKE_zpotrf_work(LAPACK_COL_MAJOR, 'L', n, L, n) == 0;
}

shb_status mhb_gyroscopic_solve(int n, const double complex *K, const double complex *G,
                                const double *loss, mhb_gyroscopic *out) {
  const size_t m = (size_t)n;
  SHB_TRY(allocate(n, out));
  double complex *L = malloc((m * m + 1) * sizeof *L), *A = malloc((4 * m * m + 1) * sizeof *A);
  shb_status      status = SHB_OK;
  if (!L || !A)
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory for %d gyroscopic modes", n);
  else if (!factor(n, K, L))
    status = shb_fail(SHB_NOT_CONVERGED, __FILE__, __LINE__, "the stiffness is not positive");
  if (status == SHB_OK) {
    assemble(n, L, G, A);
    if (LAPACKE_zheev(LAPACK_COL_MAJOR, 'V', 'L', 2 * n, A, 2 * n, out->omega) == 0)
      take_modes(A, loss, out);
    else
      status = shb_fail(SHB_NOT_CONVERGED, __FILE__, __LINE__, "no gyroscopic modes were found");
  }
  free(L);
  free(A);
  return status;
}

double complex mhb_gyroscopic_element(const modal_wave *wave, int i, int j) {
  const double *im = wave->imaginary ? wave->imaginary->coriolis : NULL;
  const size_t  at = (size_t)i * (size_t)wave->model->n_modes + (size_t)j;
  return wave->model->coriolis ? modal_wave_value(wave, wave->model->coriolis, im, at) : 0;
}

shb_status mhb_gyroscopic_of_wave(const modal_wave *wave, mhb_gyroscopic *out) {
  const int       m = wave->model->n_modes;
  const size_t    n = (size_t)m;
  double complex *K = calloc(2 * n * n + 1, sizeof *K), *G = K + n * n;
  double         *loss   = malloc((n + 1) * sizeof *loss);
  shb_status      status = SHB_OK;
  *out                   = (mhb_gyroscopic){0};
  if (K && loss) {
    for (int i = 0; i < m; i++) {
      const double omega     = SHB_TWO_PI * wave->model->frequency[i];
      K[(size_t)i * (n + 1)] = omega * omega;
      loss[i]                = 2 * wave->model->damping_ratio[i] * omega;
      for (int j = 0; j < m; j++) G[i * m + j] = mhb_gyroscopic_element(wave, i, j);
    }
    status = mhb_gyroscopic_solve(m, K, G, loss, out);
  } else {
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory for %d gyroscopic modes", m);
  }
  free(K);
  free(loss);
  return status;
}

void mhb_gyroscopic_free(mhb_gyroscopic *of) {
  free(of->omega);
  free(of->decay);
  free(of->shape);
  *of = (mhb_gyroscopic){0};
}
