#include "mhb/numerics/block_cyclic.h"

#include <cblas.h>
#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

shb_status mhb_block_cyclic_create(int blocks, int size, mhb_block_cyclic **out) {
  mhb_block_cyclic *f = calloc(1, sizeof *f);
  SHB_CHECK(f, SHB_ERR_IO, "out of memory");
  const size_t N = (size_t)blocks, s = (size_t)size;
  f->blocks  = blocks;
  f->size    = size;
  f->before  = shb_arena_take(&f->arena, N * s * s, sizeof(double));
  f->own     = shb_arena_take(&f->arena, N * s * s, sizeof(double));
  f->after   = shb_arena_take(&f->arena, N * s * s, sizeof(double));
  f->column  = shb_arena_take(&f->arena, N * s, sizeof(double));
  f->row     = shb_arena_take(&f->arena, N * s, sizeof(double));
  f->right   = shb_arena_take(&f->arena, N * s * (2 * s + 1), sizeof(double));
  f->below   = shb_arena_take(&f->arena, N * s * (2 * s + 1), sizeof(double));
  f->product = shb_arena_take(&f->arena, (2 * s + 1) * (2 * s + 1), sizeof(double));
  f->last    = shb_arena_take(&f->arena, (s + 1) * (s + 1), sizeof(double));
  f->x       = shb_arena_take(&f->arena, s + 1, sizeof(double));
  f->pivot   = shb_arena_take(&f->arena, N * (s + 1), sizeof(int));
  if (f->arena.failed) {
    mhb_block_cyclic_destroy(f);
    SHB_FAIL(SHB_ERR_IO, "out of memory for %d blocks of %d unknowns", blocks, size);
  }
  *out = f;
  return SHB_OK;
}

void mhb_block_cyclic_destroy(mhb_block_cyclic *f) {
  if (!f) return;
  shb_arena_free(&f->arena);
  free(f);
}

void mhb_block_cyclic_clear(mhb_block_cyclic *f) {
  const size_t N = (size_t)f->blocks, s = (size_t)f->size;
  memset(f->before, 0, N * s * s * sizeof(double));
  memset(f->own, 0, N * s * s * sizeof(double));
  memset(f->after, 0, N * s * s * sizeof(double));
  memset(f->column, 0, N * s * sizeof(double));
  memset(f->row, 0, N * s * sizeof(double));
  f->corner = 0;
}

/* Block i < N-1 has columns and rows in common with the next block and with the last system. The
 * next block of block N-2 is in the last system. */
static int n_next(const mhb_block_cyclic *f, int i) {
  return i < f->blocks - 2 ? f->size : 0;
}

static int n_common(const mhb_block_cyclic *f, int i) {
  return n_next(f, i) + f->size + f->borders;
}

static double *right_of(const mhb_block_cyclic *f, int i) {
  return f->right + (size_t)i * (size_t)f->size * (2 * (size_t)f->size + 1);
}

static double *below_of(const mhb_block_cyclic *f, int i) {
  return f->below + (size_t)i * (size_t)f->size * (2 * (size_t)f->size + 1);
}

static int *pivot_of(const mhb_block_cyclic *f, int i) {
  return f->pivot + (size_t)i * ((size_t)f->size + 1);
}

static void count_signs(mhb_block_cyclic *f, int n, const double *A, const int *pivot) {
  for (int i = 0; i < n; i++) {
    if (A[(size_t)i * ((size_t)n + 1)] < 0) f->sign = -f->sign;
    if (pivot[i] != i + 1) f->sign = -f->sign;
  }
}

/* A[n][n] <- its factors. 0: singular. */
static int factor_dense(mhb_block_cyclic *f, int n, double *A, int *pivot) {
  if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, A, n, pivot) != 0) return 0;
  count_signs(f, n, A, pivot);
  return 1;
}

/* rows of column-major to += those of from[s][s]; leading dimension of to. */
static void add_rows(int s, const double *from, int leading, double *to) {
  for (int j = 0; j < s; j++)
    for (int i = 0; i < s; i++) to[j * leading + i] += from[j * s + i];
}

/* The common columns and rows of block i before elimination. */
static void set_coupling(mhb_block_cyclic *f, int i) {
  const int s = f->size, end = f->blocks - 1, next = n_next(f, i), all = n_common(f, i);
  double   *right = right_of(f, i), *below = below_of(f, i);
  double   *last_columns = right + next * s, *last_rows = below + next;
  memset(right, 0, sizeof(double) * (size_t)(s * all));
  memset(below, 0, sizeof(double) * (size_t)(s * all));
  add_rows(s, mhb_block_cyclic_at(f, f->after, i), s, right); /* of the next, or of the last */
  add_rows(s, mhb_block_cyclic_at(f, f->before, i + 1), all, below);
  if (i == 0) { /* round the ring */
    add_rows(s, f->before, s, last_columns);
    add_rows(s, mhb_block_cyclic_at(f, f->after, end), all, last_rows);
  }
  for (int j = 0; j < s && f->borders; j++) {
    last_columns[s * s + j] = f->column[i * s + j];
    last_rows[j * all + s]  = f->row[i * s + j];
  }
}

static void set_last(mhb_block_cyclic *f) {
  const int     s = f->size, w = s + f->borders, end = f->blocks - 1;
  const double *own = mhb_block_cyclic_at(f, f->own, end);
  for (int j = 0; j < s; j++) memcpy(f->last + j * w, own + j * s, sizeof(double) * (size_t)s);
  if (!f->borders) return;
  for (int j = 0; j < s; j++) {
    f->last[s * w + j]     = f->column[end * s + j];
    f->last[j * w + w - 1] = f->row[end * s + j];
  }
  f->last[s * w + s] = f->corner;
}

/* to -= a part of the product, from its row and column. */
static void subtract_part(const mhb_block_cyclic *f, int all, int row, int column, int rows,
                          int columns, int leading, double *to) {
  for (int j = 0; j < columns; j++) {
    const double *from = f->product + (column + j) * all + row;
    for (int i = 0; i < rows; i++) to[j * leading + i] -= from[i];
  }
}

/* Eliminate block i: the next one and the last system lose it. 0: singular. */
static int eliminate(mhb_block_cyclic *f, int i) {
  const int s = f->size, w = s + f->borders, next = n_next(f, i), all = n_common(f, i);
  double   *own = mhb_block_cyclic_at(f, f->own, i), *right = right_of(f, i);
  if (!factor_dense(f, s, own, pivot_of(f, i))) return 0;
  LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', s, all, own, s, pivot_of(f, i), right, s);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, all, all, s, 1, below_of(f, i), all, right,
              s, 0, f->product, all);
  subtract_part(f, all, next, next, w, w, w, f->last);
  if (next == 0) return 1;
  const int after = n_common(f, i + 1), beyond = n_next(f, i + 1);
  subtract_part(f, all, 0, 0, s, s, s, mhb_block_cyclic_at(f, f->own, i + 1));
  subtract_part(f, all, 0, s, s, w, s, right_of(f, i + 1) + beyond * s);
  subtract_part(f, all, s, 0, w, s, after, below_of(f, i + 1) + beyond);
  return 1;
}

int mhb_block_cyclic_factor(mhb_block_cyclic *f, int borders) {
  f->borders = borders;
  f->sign    = 1;
  set_last(f);
  for (int i = 0; i < f->blocks - 1; i++) set_coupling(f, i);
  for (int i = 0; i < f->blocks - 1; i++)
    if (!eliminate(f, i)) return 0;
  return factor_dense(f, f->size + borders, f->last, pivot_of(f, f->blocks - 1));
}

/* y[rows] -= A x, A[rows][columns] column-major. */
static void subtract_from(int rows, int columns, const double *A, int leading, const double *x,
                          double *y) {
  cblas_dgemv(CblasColMajor, CblasNoTrans, rows, columns, -1, A, leading, x, 1, 1, y, 1);
}

void mhb_block_cyclic_solve(mhb_block_cyclic *f, double *rhs) {
  const int s = f->size, w = s + f->borders, end = f->blocks - 1;
  memcpy(f->x, rhs + (size_t)end * (size_t)s, sizeof(double) * (size_t)w);
  for (int i = 0; i < end; i++) {
    const int next = n_next(f, i), all = n_common(f, i);
    double   *y = rhs + (size_t)i * (size_t)s;
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', s, 1, mhb_block_cyclic_at(f, f->own, i), s,
                        pivot_of(f, i), y, s);
    if (next) subtract_from(s, s, below_of(f, i), all, y, y + s);
    subtract_from(w, s, below_of(f, i) + next, all, y, f->x);
  }
  LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', w, 1, f->last, w, pivot_of(f, end), f->x, w);
  memcpy(rhs + (size_t)end * (size_t)s, f->x, sizeof(double) * (size_t)w);
  for (int i = end - 1; i >= 0; i--) {
    const int next = n_next(f, i);
    double   *y    = rhs + (size_t)i * (size_t)s;
    if (next) subtract_from(s, s, right_of(f, i), s, y + s, y);
    subtract_from(s, w, right_of(f, i) + next * s, s, f->x, y);
  }
}
