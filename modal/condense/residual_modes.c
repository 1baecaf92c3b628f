#include "modal/condense/residual_modes.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

enum { BLOCKS = MODAL_RESIDUAL_BLOCKS };

static const double DEPENDENT = 1e-12;

/* Square matrices [n][n], row-major. */
typedef struct {
  int     columns, n, kept;
  double *K, *M, *T, *value, *scale;
} problem;

static void make_symmetric(double *a, int n) {
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++) a[i * n + j] = a[j * n + i] = (a[i * n + j] + a[j * n + i]) / 2;
}

/* G[(i, a)][(j, b)] = moment[i + j + first][a][b] */
static void fill(const problem *p, double *const *moment, int first, double *G) {
  const size_t c = (size_t)p->columns, n = (size_t)p->n;
  for (size_t i = 0; i < BLOCKS; i++)
    for (size_t j = 0; j < BLOCKS; j++)
      for (size_t a = 0; a < c; a++)
        memcpy(G + (i * c + a) * n + j * c, moment[i + j + (size_t)first] + a * c, c * sizeof *G);
}

/* Scale the columns to unit mass; a column without mass is dropped. */
static void scale_columns(problem *p) {
  const int n = p->n;
  for (int i = 0; i < n; i++) {
    double mass = p->M[i * n + i];
    p->scale[i] = mass > 0 ? 1 / sqrt(mass) : 0;
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      p->K[i * n + j] *= p->scale[i] * p->scale[j];
      p->M[i * n + j] *= p->scale[i] * p->scale[j];
    }
}

/* T [n][kept] with T^T M T = 1; M is overwritten. */
static int orthonormal(problem *p) {
  const int n = p->n;
  if (LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'V', 'U', n, p->M, n, p->value) != 0) return 0;
  int first = 0;
  while (first < n && !(p->value[first] > DEPENDENT * p->value[n - 1])) first++;
  p->kept = n - first;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < p->kept; k++)
      p->T[i * p->kept + k] = p->M[i * n + first + k] / sqrt(p->value[first + k]);
  return 1;
}

/* Eigenvalues of T^T K T into value, its eigenvectors into K [kept][kept]. */
static int reduce(problem *p) {
  const int n = p->n, m = p->kept;
  double   *KT = p->M, *A = p->K; /* the first product is the last use of K */
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, m, n, 1, p->K, n, p->T, m, 0, KT, m);
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, m, m, n, 1, p->T, m, KT, m, 0, A, m);
  make_symmetric(A, m);
  return m == 0 || LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'V', 'U', m, A, m, p->value) == 0;
}

static void store(const problem *p, modal_residual_modes *ritz) {
  const int n = p->n, m = p->kept;
  ritz->n      = m;
  ritz->lambda = shb_alloc((size_t)m + 1, sizeof(double));
  ritz->weight = shb_alloc((size_t)n * (size_t)m + 1, sizeof(double));
  memcpy(ritz->lambda, p->value, (size_t)m * sizeof(double));
  if (m == 0) return;
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, m, m, 1, p->T, m, p->K, m, 0,
              ritz->weight, m);
  for (int i = 0; i < n; i++)
    for (int k = 0; k < m; k++) ritz->weight[i * m + k] *= p->scale[i];
}

shb_status modal_residual_modes_create(int columns, double *const moment[2 * BLOCKS],
                                       modal_residual_modes *ritz) {
  const size_t n     = BLOCKS * (size_t)columns;
  double      *space = shb_alloc_zeroed(3 * n * n + 2 * n + 1, sizeof *space);
  memset(ritz, 0, sizeof *ritz);
  problem p = {.columns = columns, .n = (int)n};
  p.K       = space;
  p.M       = p.K + n * n;
  p.T       = p.M + n * n;
  p.value   = p.T + n * n;
  p.scale   = p.value + n;
  for (int j = 0; j < 2 * BLOCKS; j++) make_symmetric(moment[j], columns);
  fill(&p, moment, 0, p.K);
  fill(&p, moment, 1, p.M);
  scale_columns(&p);
  const bool found = orthonormal(&p) && reduce(&p);
  if (found) store(&p, ritz);
  free(space);
  SHB_CHECK(found, SHB_ERR_IO, "the eigenvalues of the residual modes were not found");
  return SHB_OK;
}

void modal_residual_modes_free(modal_residual_modes *ritz) {
  free(ritz->lambda);
  free(ritz->weight);
  *ritz = (modal_residual_modes){0};
}

int modal_residual_modes_needed(const modal_residual_modes *ritz, int columns, const double *psi,
                                const double *scale, double s, double tolerance) {
  int needed = 0;
  for (int c = 0; c < columns; c++) {
    int    n    = ritz->n;
    double left = 0;
    for (; n > needed; n--) {
      double ratio = s / ritz->lambda[n - 1], shape = psi[c * ritz->n + n - 1];
      left += shape * shape * ratio * ratio * ratio / (ritz->lambda[n - 1] - s);
      if (left > tolerance * scale[c]) break;
    }
    if (n > needed) needed = n;
  }
  return needed;
}
