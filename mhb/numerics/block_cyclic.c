#include "mhb/numerics/block_cyclic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/numerics/simd.h"

/* Rows and vectors of a tile of a product that the 16 registers of AVX2 hold. */
enum { TILE_ROWS = 4, TILE_VECTORS = 2, TILE = TILE_VECTORS * MHB_HALF_LANES };

static int whole_tiles(int n) {
  return (n + TILE - 1) / TILE * TILE;
}

shb_status mhb_block_cyclic_create(int blocks, int size, mhb_block_cyclic **out) {
  mhb_block_cyclic *f = calloc(1, sizeof *f);
  SHB_CHECK(f, SHB_ERR_IO, "out of memory");
  const size_t N = (size_t)blocks, s = (size_t)size;
  f->blocks  = blocks;
  f->size    = size;
  f->first   = mhb_whole_lanes(size);
  f->width   = f->first + whole_tiles(2 * size + 1);
  f->before  = shb_arena_take(&f->arena, N * s * s, sizeof(double));
  f->own     = shb_arena_take(&f->arena, N * s * s, sizeof(double));
  f->after   = shb_arena_take(&f->arena, N * s * s, sizeof(double));
  f->column  = shb_arena_take(&f->arena, N * s, sizeof(double));
  f->row     = shb_arena_take(&f->arena, N * s, sizeof(double));
  f->rows    = shb_arena_take(&f->arena, N * s * (size_t)f->width, sizeof(double));
  f->below   = shb_arena_take(&f->arena, N * s * (2 * s + 1), sizeof(double));
  f->product = shb_arena_take(&f->arena, (2 * s + 1) * (size_t)f->width, sizeof(double));
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

/* Rows of block i: own, then from `first` on the common columns. */
static double *rows_of(const mhb_block_cyclic *f, int i) {
  return f->rows + (size_t)i * (size_t)f->size * (size_t)f->width;
}

static double *below_of(const mhb_block_cyclic *f, int i) {
  return f->below + (size_t)i * (size_t)f->size * (2 * (size_t)f->size + 1);
}

static int *pivot_of(const mhb_block_cyclic *f, int i) {
  return f->pivot + (size_t)i * ((size_t)f->size + 1);
}

/* ---- dense kernels, row-major ---- */

/* y[n] -= a x[n] */
MHB_INLINE void subtract(int n, double a, const double *restrict x, double *restrict y) {
  for (int j = 0; j < n; j++) y[j] -= a * x[j];
}

static void swap_rows(int n, double *restrict x, double *restrict y) {
  for (int j = 0; j < n; j++) {
    const double old = x[j];
    x[j]             = y[j];
    y[j]             = old;
  }
}

/* Gaussian elimination of the first n columns of A[n][width], with row exchanges in all columns.
 * The sign of the determinant; 0: singular. */
MHB_HOT static int eliminate_rows(int n, int width, double *A, int *pivot) {
  int sign = 1;
  for (int p = 0; p < n; p++) {
    double *row  = A + p * width;
    int     best = p;
    for (int i = p + 1; i < n; i++)
      if (fabs(A[i * width + p]) > fabs(A[best * width + p])) best = i;
    pivot[p] = best;
    if (best != p) {
      swap_rows(width, row, A + best * width);
      sign = -sign;
    }
    if (row[p] < 0) sign = -sign;
    if (!(fabs(row[p]) > 0) || !isfinite(row[p])) return 0;
    const double inverse = 1 / row[p];
    for (int i = p + 1; i < n; i++) {
      double *to = A + i * width;
      to[p] *= inverse;
      subtract(n - p - 1, to[p], row + p + 1, to + p + 1);
    }
  }
  return sign;
}

MHB_INLINE double dot(int n, const double *a, const double *b) {
  double sum = 0;
  for (int j = 0; j < n; j++) sum += a[j] * b[j];
  return sum;
}

/* x[n] <- A^-1 x with the factors in A[n][width] */
MHB_HOT static void solve_rows(int n, int width, const double *A, const int *pivot, double *x) {
  for (int p = 0; p < n; p++) {
    const double old = x[p];
    x[p]             = x[pivot[p]];
    x[pivot[p]]      = old;
  }
  for (int i = 1; i < n; i++) x[i] -= dot(i, A + i * width, x);
  for (int i = n - 1; i >= 0; i--) {
    const double *row = A + i * width;
    x[i]              = (x[i] - dot(n - i - 1, row + i + 1, x + i + 1)) / row[i];
  }
}

/* sum[rows][a tile] -= A[rows][from..to) X, both with rows of width */
MHB_INLINE void subtract_tile(int rows, int from, int to, int width, const double *A,
                              const double *X, mhb_half_lanes sum[TILE_ROWS][TILE_VECTORS]) {
  for (int l = from; l < to; l++)
    for (int i = 0; i < rows; i++)
      for (int j = 0; j < TILE_VECTORS; j++)
        sum[i][j] -= A[i * width + l] * half_lanes_load(X + l * width + j * MHB_HALF_LANES);
}

MHB_INLINE void load_tile(int rows, int width, const double *X,
                          mhb_half_lanes sum[TILE_ROWS][TILE_VECTORS]) {
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < TILE_VECTORS; j++)
      sum[i][j] = half_lanes_load(X + i * width + j * MHB_HALF_LANES);
}

MHB_INLINE void store_tile(int rows, int width, double *X,
                           mhb_half_lanes sum[TILE_ROWS][TILE_VECTORS]) {
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < TILE_VECTORS; j++)
      half_lanes_store(X + i * width + j * MHB_HALF_LANES, sum[i][j]);
}

/* Rows `at` on of a tile of X <- those of lower factor^-1 X; the rows before are solved. */
MHB_INLINE void lower_tile(int rows, int at, int width, const double *A, double *X) {
  mhb_half_lanes sum[TILE_ROWS][TILE_VECTORS] = {{{0}}};
  A += at * width;
  load_tile(rows, width, X + at * width, sum);
  subtract_tile(rows, 0, at, width, A, X, sum);
  for (int i = 1; i < rows; i++)
    for (int l = 0; l < i; l++)
      for (int j = 0; j < TILE_VECTORS; j++) sum[i][j] -= A[i * width + at + l] * sum[l][j];
  store_tile(rows, width, X + at * width, sum);
}

/* The same of the upper factor of n rows; the rows behind are solved. */
MHB_INLINE void upper_tile(int rows, int at, int n, int width, const double *A,
                           const double *inverse, double *X) {
  mhb_half_lanes sum[TILE_ROWS][TILE_VECTORS] = {{{0}}};
  A += at * width;
  load_tile(rows, width, X + at * width, sum);
  subtract_tile(rows, at + rows, n, width, A, X, sum);
  for (int i = rows - 1; i >= 0; i--) {
    for (int l = i + 1; l < rows; l++)
      for (int j = 0; j < TILE_VECTORS; j++) sum[i][j] -= A[i * width + at + l] * sum[l][j];
    for (int j = 0; j < TILE_VECTORS; j++) sum[i][j] *= inverse[at + i];
  }
  store_tile(rows, width, X + at * width, sum);
}

/* `columns` columns of A[n][width] from `first` on, in whole tiles, <- the solution with the
 * factors in its first n columns. */
MHB_HOT static void substitute_rows(int n, int width, int first, int columns, double *A) {
  const int whole = n / TILE_ROWS * TILE_ROWS;
  double    inverse[n];
  for (int i = 0; i < n; i++) inverse[i] = 1 / A[i * (width + 1)];
  for (double *X = A + first; X < A + first + columns; X += TILE) {
    for (int i = 0; i < whole; i += TILE_ROWS) lower_tile(TILE_ROWS, i, width, A, X);
    for (int i = whole; i < n; i++) lower_tile(1, i, width, A, X);
    for (int i = n - 1; i >= whole; i--) upper_tile(1, i, n, width, A, inverse, X);
    for (int i = whole - TILE_ROWS; i >= 0; i -= TILE_ROWS)
      upper_tile(TILE_ROWS, i, n, width, A, inverse, X);
  }
}

/* A tile of the product of A[..][s] and B[s][width]. */
MHB_INLINE void multiply_tile(int rows, int s, int width, const double *A, const double *B,
                              double *C) {
  mhb_half_lanes sum[TILE_ROWS][TILE_VECTORS] = {{{0}}};
  for (int l = 0; l < s; l++)
    for (int i = 0; i < rows; i++)
      for (int j = 0; j < TILE_VECTORS; j++)
        sum[i][j] += A[i * s + l] * half_lanes_load(B + l * width + j * MHB_HALF_LANES);
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < TILE_VECTORS; j++)
      half_lanes_store(C + i * width + j * MHB_HALF_LANES, sum[i][j]);
}

/* C[rows][columns] <- A[rows][s] B[s][columns], columns in whole tiles; B and C have rows of
 * width. */
MHB_HOT static void multiply(int rows, int columns, int s, int width, const double *A,
                             const double *B, double *C) {
  for (int i = 0; i < rows; i += TILE_ROWS)
    for (int j = 0; j < columns; j += TILE) {
      if (i + TILE_ROWS <= rows)
        multiply_tile(TILE_ROWS, s, width, A + i * s, B + j, C + i * width + j);
      else
        for (int one = i; one < rows; one++)
          multiply_tile(1, s, width, A + one * s, B + j, C + one * width + j);
    }
}

/* ---- factors ---- */

/* to[s][..] <- from[s][s], then zeros up to `columns` */
static void set_block(int s, const double *from, int columns, int width, double *to) {
  for (int i = 0; i < s; i++, from += s, to += width) {
    memcpy(to, from, sizeof(double) * (size_t)s);
    memset(to + s, 0, sizeof(double) * (size_t)(columns - s));
  }
}

/* to[s][..] += from[s][s] */
static void add_block(int s, const double *from, int width, double *to) {
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) to[i * width + j] += from[i * s + j];
}

/* Rows and common columns of block i before elimination. The block after is the next one, or the
 * last. */
static void set_coupling(mhb_block_cyclic *f, int i) {
  const int s = f->size, end = f->blocks - 1, next = n_next(f, i), all = n_common(f, i);
  double   *rows = rows_of(f, i), *below = below_of(f, i), *common = rows + f->first;
  set_block(s, mhb_block_cyclic_at(f, f->own, i), f->first, f->width, rows);
  set_block(s, mhb_block_cyclic_at(f, f->after, i), f->width - f->first, f->width, common);
  memcpy(below, mhb_block_cyclic_at(f, f->before, i + 1), sizeof(double) * (size_t)(s * s));
  memset(below + s * s, 0, sizeof(double) * (size_t)(s * (all - s)));
  if (i == 0) { /* round the ring */
    add_block(s, f->before, f->width, common + next);
    add_block(s, mhb_block_cyclic_at(f, f->after, end), s, below + next * s);
  }
  for (int j = 0; j < s && f->borders; j++) {
    common[j * f->width + next + s] = f->column[i * s + j];
    below[(next + s) * s + j]       = f->row[i * s + j];
  }
}

static void set_last(mhb_block_cyclic *f) {
  const int     s = f->size, w = s + f->borders, end = f->blocks - 1;
  const double *own = mhb_block_cyclic_at(f, f->own, end);
  for (int i = 0; i < s; i++) {
    memcpy(f->last + i * w, own + i * s, sizeof(double) * (size_t)s);
    if (f->borders) f->last[i * w + s] = f->column[end * s + i];
    if (f->borders) f->last[s * w + i] = f->row[end * s + i];
  }
  if (f->borders) f->last[s * w + s] = f->corner;
}

/* to[rows][columns] -= a part of the product, from its row and column. */
static void subtract_part(const mhb_block_cyclic *f, int row, int column, int rows, int columns,
                          int width, double *to) {
  for (int i = 0; i < rows; i++)
    subtract(columns, 1, f->product + (row + i) * f->width + column, to + i * width);
}

/* Eliminate block i: the next one and the last system lose it. 0: singular. */
static int eliminate(mhb_block_cyclic *f, int i) {
  const int s = f->size, w = s + f->borders, next = n_next(f, i), all = n_common(f, i);
  const int columns = whole_tiles(all),
            sign    = eliminate_rows(s, f->width, rows_of(f, i), pivot_of(f, i));
  double *common    = rows_of(f, i) + f->first;
  f->sign *= sign;
  if (!sign) return 0;
  substitute_rows(s, f->width, f->first, columns, rows_of(f, i));
  multiply(all, columns, s, f->width, below_of(f, i), common, f->product);
  subtract_part(f, next, next, w, w, w, f->last);
  if (next == 0) return 1;
  const int beyond = n_next(f, i + 1);
  double   *to     = rows_of(f, i + 1);
  subtract_part(f, 0, 0, s, s, f->width, to);
  subtract_part(f, 0, s, s, w, f->width, to + f->first + beyond);
  subtract_part(f, s, 0, w, s, s, below_of(f, i + 1) + beyond * s);
  return 1;
}

int mhb_block_cyclic_factor(mhb_block_cyclic *f, int borders) {
  const int end = f->blocks - 1, w = f->size + borders;
  f->borders = borders;
  f->sign    = 1;
  set_last(f);
  for (int i = 0; i < end; i++) set_coupling(f, i);
  for (int i = 0; i < end; i++)
    if (!eliminate(f, i)) return 0;
  f->sign *= eliminate_rows(w, w, f->last, pivot_of(f, end));
  return f->sign != 0;
}

/* ---- solutions ---- */

/* y[rows] -= A x, A[rows][columns] with rows of width. */
MHB_HOT static void subtract_from(int rows, int columns, int width, const double *A,
                                  const double *x, double *y) {
  for (int i = 0; i < rows; i++) y[i] -= dot(columns, A + i * width, x);
}

void mhb_block_cyclic_solve(mhb_block_cyclic *f, double *rhs) {
  const int s = f->size, w = s + f->borders, end = f->blocks - 1;
  memcpy(f->x, rhs + (size_t)end * (size_t)s, sizeof(double) * (size_t)w);
  for (int i = 0; i < end; i++) {
    const int next = n_next(f, i);
    double   *y    = rhs + (size_t)i * (size_t)s;
    solve_rows(s, f->width, rows_of(f, i), pivot_of(f, i), y);
    subtract_from(next, s, s, below_of(f, i), y, y + s);
    subtract_from(w, s, s, below_of(f, i) + next * s, y, f->x);
  }
  solve_rows(w, w, f->last, pivot_of(f, end), f->x);
  memcpy(rhs + (size_t)end * (size_t)s, f->x, sizeof(double) * (size_t)w);
  for (int i = end - 1; i >= 0; i--) {
    const int     next   = n_next(f, i);
    const double *common = rows_of(f, i) + f->first;
    double       *y      = rhs + (size_t)i * (size_t)s;
    subtract_from(s, next, f->width, common, y + s, y);
    subtract_from(s, w, f->width, common + next, f->x, y);
  }
}
