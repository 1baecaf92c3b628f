#include "mhb/variation/stuck_springs.h"

#include <cblas.h>
#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

mhb_stuck_springs *mhb_stuck_springs_create(const mhb_modal_structure *s) {
  mhb_stuck_springs *x        = shb_alloc_zeroed(1, sizeof *x);
  size_t             contacts = (size_t)s->contacts, n = 3 * contacts, m = (size_t)s->modes;
  x->structure = s;
  x->n         = (int)n;
  x->modes     = s->modes;
  x->flexible  = s->flexibility != NULL;
  x->law       = shb_arena_take(&x->arena, contacts, sizeof *x->law);
  x->K         = shb_arena_take(&x->arena, 9 * contacts, sizeof(double));
  x->shape     = shb_arena_take(&x->arena, n * m, sizeof(double));
  x->stuck     = shb_arena_take(&x->arena, n * m, sizeof(double));
  x->lost      = shb_arena_take(&x->arena, n * m, sizeof(double));
  x->stiffness = shb_arena_take(&x->arena, m * m, sizeof(double));
  if (x->flexible) {
    x->slider = shb_arena_take(&x->arena, n * n, sizeof(double));
    x->matrix = shb_arena_take(&x->arena, n * n, sizeof(double));
    x->pivot  = shb_arena_take(&x->arena, n, sizeof(int));
  }
  mhb_stuck_springs_forget(x);
  return x;
}

void mhb_stuck_springs_destroy(mhb_stuck_springs *x) {
  if (!x) return;
  shb_arena_free(&x->arena);
  free(x);
}

void mhb_stuck_springs_forget(mhb_stuck_springs *x) {
  x->law[0].kv = -1;
}

void mhb_stuck_springs_force(const mhb_stuck_springs *x, int contact, const double u[3],
                             double out[3]) {
  const double *K = x->K + 9 * (size_t)contact;
  for (int r = 0; r < 3; r++) out[r] = K[3 * r] * u[0] + K[3 * r + 1] * u[1] + K[3 * r + 2] * u[2];
}

static bool is_same(const mhb_stuck_springs *x, const mhb_law *law) {
  for (int j = 0; j < x->structure->contacts; j++) {
    const mhb_law *a = &x->law[j], *b = &law[j];
    if (a->kv != b->kv || (a->mu > 0) != (b->mu > 0) || a->ku[0] != b->ku[0] ||
        a->ku[1] != b->ku[1] || a->ku[2] != b->ku[2])
      return false;
  }
  return true;
}

static void set_stiffness(mhb_stuck_springs *x, int contact) {
  const mhb_law *law = &x->law[contact];
  double        *K   = x->K + 9 * (size_t)contact;
  memset(K, 0, 9 * sizeof *K);
  K[0] = law->kv;
  if (!(law->mu > 0)) return;
  K[4] = law->ku[0];
  K[5] = K[7] = law->ku[1];
  K[8]        = law->ku[2];
}

/* matrix = I + R K, by rows. */
static void set_matrix(mhb_stuck_springs *x) {
  size_t n = (size_t)x->n;
  for (size_t r = 0; r < n; r++)
    for (size_t c = 0; c < n; c++) {
      const double *R      = x->structure->flexibility + r * n + c - c % 3;
      const double *K      = x->K + 3 * (c - c % 3) + c % 3; /* column c % 3 of its block */
      x->matrix[r * n + c] = (r == c) + R[0] * K[0] + R[1] * K[3] + R[2] * K[6];
    }
}

/* L~ and S. Returns 0 if singular. */
static int solve(mhb_stuck_springs *x) {
  const int n = x->n, m = x->modes;
  double   *columns = x->lost; /* [m][n] */
  memcpy(columns, x->structure->shape, sizeof *columns * (size_t)m * (size_t)n);
  memcpy(x->slider, x->structure->flexibility, sizeof *x->slider * (size_t)n * (size_t)n);
  set_matrix(x);
  /* rows are columns for LAPACK, which factors the transposed matrix */
  if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, x->matrix, n, x->pivot) != 0 ||
      LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', n, m, x->matrix, n, x->pivot, columns, n) != 0 ||
      LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', n, n, x->matrix, n, x->pivot, x->slider, n) != 0)
    return 0;
  for (int k = 0; k < n * m; k++) x->stuck[k] = columns[k % m * n + k / m];
  for (int r = 0; r < n; r++)
    for (int c = 0; c < r; c++)
      x->slider[r * n + c] = x->slider[c * n + r] =
          0.5 * (x->slider[r * n + c] + x->slider[c * n + r]);
  return 1;
}

int mhb_stuck_springs_set(mhb_stuck_springs *x, const mhb_law *law) {
  const int n = x->n, m = x->modes;
  if (is_same(x, law)) return 1;
  memcpy(x->law, law, sizeof *law * (size_t)x->structure->contacts);
  for (int j = 0; j < x->structure->contacts; j++) set_stiffness(x, j);
  for (int k = 0; k < n * m; k++) x->shape[k] = x->structure->shape[k % m * n + k / m];
  if (!x->flexible) {
    memcpy(x->stuck, x->shape, sizeof *x->stuck * (size_t)n * (size_t)m);
  } else if (!solve(x)) {
    mhb_stuck_springs_forget(x);
    return 0;
  }
  for (int k = 0; k < n * m; k++) x->lost[k] = x->shape[k] - x->stuck[k];
  memset(x->stiffness, 0, sizeof *x->stiffness * (size_t)m * (size_t)m);
  for (int r = 0; r < n; r++) { /* row r of K L~ times row r of L */
    const double *K = x->K + 3 * r, *block = x->stuck + (size_t)(r - r % 3) * (size_t)m;
    for (int i = 0; i < m; i++)
      for (int k = 0; k < m; k++)
        x->stiffness[i * m + k] +=
            x->shape[r * m + i] * (K[0] * block[k] + K[1] * block[m + k] + K[2] * block[2 * m + k]);
  }
  return 1;
}
