#include "mhb/structure/gyroscopic.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"

static void allocate(int n, mhb_gyroscopic *out) {
  const size_t m = (size_t)n;
  *out           = (mhb_gyroscopic){.n     = n,
                                    .omega = shb_alloc(2 * m + 1, sizeof *out->omega),
                                    .decay = shb_alloc(2 * m + 1, sizeof *out->decay),
                                    .shape = shb_alloc(2 * m * m + 1, sizeof *out->shape)};
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
  allocate(n, out);
  double complex *L = shb_alloc(m * m + 1, sizeof *L), *A = shb_alloc(4 * m * m + 1, sizeof *A);
  shb_status      status = SHB_OK;
  if (!factor(n, K, L))
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
  double complex *K = shb_alloc_zeroed(2 * n * n + 1, sizeof *K), *G = K + n * n;
  double         *loss = shb_alloc(n + 1, sizeof *loss);
  for (int i = 0; i < m; i++) {
    const double omega     = SHB_TWO_PI * wave->model->frequency[i];
    K[(size_t)i * (n + 1)] = omega * omega;
    loss[i]                = 2 * wave->model->damping_ratio[i] * omega;
    for (int j = 0; j < m; j++) G[i * m + j] = mhb_gyroscopic_element(wave, i, j);
  }
  const shb_status status = mhb_gyroscopic_solve(m, K, G, loss, out);
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

/* ---- with damping ---- */

/* Eigenvalues, eigenvectors V and V^-1, by columns. */
typedef struct {
  lapack_int      n; /* twice the coordinates */
  double complex *A, *value, *V, *inverse;
  int            *place;     /* eigenvalue of each amplitude */
  lapack_int     *exchanges; /* of rows */
} eigenvectors;

static void take_room(size_t all, eigenvectors *e) {
  e->A         = shb_alloc_zeroed(all * (3 * all + 1) + 1, sizeof *e->A);
  e->place     = shb_alloc(all + 1, sizeof *e->place);
  e->exchanges = shb_alloc(all + 1, sizeof *e->exchanges);
  e->V         = e->A + all * all;
  e->inverse   = e->V + all * all;
  e->value     = e->inverse + all * all;
}

static void free_room(eigenvectors *e) {
  free(e->A);
  free(e->place);
  free(e->exchanges);
}

static bool find(int n, const double *omega, const double *loss, const double complex *G,
                 eigenvectors *e) {
  const size_t m = (size_t)n, all = 2 * m;
  for (size_t j = 0; j < m; j++) {
    e->A[j * all + m + j]   = -omega[j];
    e->A[(m + j) * all + j] = omega[j];
    for (size_t i = 0; i < m; i++) e->A[(m + j) * all + m + i] = -G[i * m + j];
    e->A[(m + j) * all + m + j] -= loss[j];
  }
  if (LAPACKE_zgeev(LAPACK_COL_MAJOR, 'N', 'V', e->n, e->A, e->n, e->value, NULL, 1, e->V, e->n))
    return false;
  memcpy(e->inverse, e->V, all * all * sizeof *e->V);
  return LAPACKE_zgetrf(LAPACK_COL_MAJOR, e->n, e->n, e->inverse, e->n, e->exchanges) == 0 &&
         LAPACKE_zgetri(LAPACK_COL_MAJOR, e->n, e->inverse, e->n, e->exchanges) == 0;
}

/* The eigenvalues above the real axis come first. */
static shb_status part(int n, eigenvectors *e) {
  int above = 0, below = 0;
  for (int i = 0; i < 2 * n; i++) {
    const bool up = cimag(e->value[i]) > 0;
    if ((up ? above : below) < n) e->place[up ? above : n + below] = i;
    *(up ? &above : &below) += 1;
  }
  SHB_CHECK(above == n, SHB_ERR_INPUT,
            "%d of %d modes oscillate with Coriolis terms; the damping is too high", above, n);
  return SHB_OK;
}

static void take_amplitudes(const double *omega, const eigenvectors *e, mhb_damped_modes *out) {
  const size_t m = (size_t)out->n, all = 2 * m;
  for (size_t a = 0; a < all; a++) {
    const size_t at = (size_t)e->place[a];
    out->pole[a]    = e->value[at];
    for (size_t j = 0; j < all; j++) {
      const double scale             = j < m ? omega[j] : 1;
      out->to_state[j * all + a]     = e->V[at * all + j] / scale;
      out->to_amplitude[a * all + j] = scale * e->inverse[j * all + at];
    }
  }
}

shb_status mhb_damped_modes_solve(int n, const double *omega, const double *loss,
                                  const double complex *G, mhb_damped_modes *out) {
  const size_t all    = 2 * (size_t)n;
  *out                = (mhb_damped_modes){.n = n};
  out->pole           = shb_alloc(all + 1, sizeof *out->pole);
  out->to_state       = shb_alloc(all * all + 1, sizeof *out->to_state);
  out->to_amplitude   = shb_alloc(all * all + 1, sizeof *out->to_amplitude);
  eigenvectors e      = {.n = (lapack_int)all};
  shb_status   status = SHB_OK;
  take_room(all, &e);
  if (!find(n, omega, loss, G, &e))
    status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__, "no gyroscopic modes were found");
  if (status == SHB_OK) status = part(n, &e);
  if (status == SHB_OK) take_amplitudes(omega, &e, out);
  free_room(&e);
  return status;
}

void mhb_damped_modes_free(mhb_damped_modes *of) {
  free(of->pole);
  free(of->to_state);
  free(of->to_amplitude);
  *of = (mhb_damped_modes){0};
}
