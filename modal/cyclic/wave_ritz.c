#include "modal/cyclic/wave_ritz.h"

#include <cblas.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "modal/cyclic/small_hermitian.h"

enum { BLOCKS = MODAL_RESIDUAL_BLOCKS };

static const double         DEPENDENT = 1e-12; /* as of the real residual modes */
static const double complex one = 1, zero = 0;

/* Square matrices [n][n], row-major. */
typedef struct {
  int             columns, n, kept;
  double complex *K, *M, *T;
  double         *value, *scale;
} problem;

void wave_make_hermitian(double complex *a, int n) {
  for (int i = 0; i < n; i++)
    for (int j = 0; j <= i; j++) {
      a[i * n + j] = (a[i * n + j] + conj(a[j * n + i])) / 2;
      a[j * n + i] = conj(a[i * n + j]);
    }
}

/* G[(i, a)][(j, b)] = moment[i + j + first][a][b] */
static void fill(const problem *p, double complex *const *moment, int first, double complex *G) {
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
    const double mass = creal(p->M[i * n + i]);
    p->scale[i]       = mass > 0 ? 1 / sqrt(mass) : 0;
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      p->K[i * n + j] *= p->scale[i] * p->scale[j];
      p->M[i * n + j] *= p->scale[i] * p->scale[j];
    }
}

/* T [n][kept] with T^H M T = 1; M is overwritten.
 *
 * By columns M is transposed, thus conjugate, and so are its eigenvectors. Room follows M and K:
 * zgemv_n of OpenBLAS 0.3.21 reads beyond the end of a matrix. */
static bool orthonormal(problem *p) {
  const int n = p->n;
  if (!small_hermitian_eigen(n, p->M, p->value, true)) return false;
  int first = 0;
  while (first < n && !(p->value[first] > DEPENDENT * p->value[n - 1])) first++;
  p->kept = n - first;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < p->kept; k++)
      p->T[i * p->kept + k] = conj(p->M[(first + k) * n + i]) / sqrt(p->value[first + k]);
  return true;
}

/* Eigenvalues of T^H K T into value; row k of K [kept][kept] is the conjugate of eigenvector k. */
static bool reduce(problem *p) {
  const int       n = p->n, m = p->kept;
  double complex *KT = p->M, *A = p->K; /* the first product is the last use of K */
  if (m == 0) return true;
  cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, m, n, &one, p->K, n, p->T, m, &zero, KT,
              m);
  cblas_zgemm(CblasRowMajor, CblasConjTrans, CblasNoTrans, m, m, n, &one, p->T, m, KT, m, &zero, A,
              m);
  wave_make_hermitian(A, m);
  return small_hermitian_eigen(m, A, p->value, true);
}

static void store(const problem *p, wave_ritz *ritz) {
  const int n = p->n, m = p->kept;
  ritz->n      = m;
  ritz->lambda = shb_alloc((size_t)m + 1, sizeof *ritz->lambda);
  ritz->weight = shb_alloc((size_t)n * (size_t)m + 1, sizeof *ritz->weight);
  memcpy(ritz->lambda, p->value, (size_t)m * sizeof *ritz->lambda);
  if (m == 0) return;
  cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasConjTrans, n, m, m, &one, p->T, m, p->K, m, &zero,
              ritz->weight, m);
  for (int i = 0; i < n; i++)
    for (int k = 0; k < m; k++) ritz->weight[i * m + k] *= p->scale[i];
}

shb_status wave_ritz_create(int columns, double complex *const moment[2 * BLOCKS],
                            wave_ritz *ritz) {
  const size_t    n      = BLOCKS * (size_t)columns;
  double complex *space  = shb_alloc_zeroed(3 * n * n + 1, sizeof *space);
  double         *values = shb_alloc_zeroed(2 * n + 1, sizeof *values);
  problem         p      = {.columns = columns, .n = (int)n, .K = space, .value = values};
  memset(ritz, 0, sizeof *ritz);
  p.M     = p.K + n * n;
  p.T     = p.M + n * n;
  p.scale = p.value + n;
  for (int j = 0; j < 2 * BLOCKS; j++) wave_make_hermitian(moment[j], columns);
  fill(&p, moment, 0, p.K);
  fill(&p, moment, 1, p.M);
  scale_columns(&p);
  const bool found = orthonormal(&p) && reduce(&p);
  if (found) store(&p, ritz);
  free(space);
  free(values);
  SHB_CHECK(found, SHB_ERR_IO, "the eigenvalues of the residual modes were not found");
  return SHB_OK;
}

void wave_ritz_free(wave_ritz *ritz) {
  free(ritz->lambda);
  free(ritz->weight);
  *ritz = (wave_ritz){0};
}
