#include "mhb/numerics/block_cyclic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/numerics/simd.h"

mhb_block_cyclic *mhb_block_cyclic_create(int blocks, int size) {
  mhb_block_cyclic *f = shb_alloc_zeroed(1, sizeof *f);
  const size_t      N = (size_t)blocks, s = (size_t)size;
  f->blocks  = blocks;
  f->size    = size;
  f->first   = mhb_whole_lanes(size);
  f->width   = f->first + mhb_whole_lanes(2 * size + 1);
  f->beyond  = mhb_whole_lanes(size + 1);
  f->column  = shb_arena_take(&f->arena, N * s, sizeof(double));
  f->row     = shb_arena_take(&f->arena, N * s, sizeof(double));
  f->rows    = shb_arena_take(&f->arena, N * s * (size_t)f->width, sizeof(double));
  f->below   = shb_arena_take(&f->arena, N * (2 * s + 1) * (size_t)f->first, sizeof(double));
  f->product = shb_arena_take(&f->arena, (2 * s + 1) * (size_t)f->width, sizeof(double));
  f->last    = shb_arena_take(&f->arena, (s + 1) * (size_t)f->beyond, sizeof(double));
  f->x       = shb_arena_take(&f->arena, s + 1, sizeof(double));
  f->padded  = shb_arena_take(&f->arena, (size_t)f->width, sizeof(double));
  f->work    = shb_arena_take(&f->arena, 2 * (size_t)f->beyond, sizeof(double));
  f->pivot   = shb_arena_take(&f->arena, N * (s + 1), sizeof(int));
  return f;
}

void mhb_block_cyclic_destroy(mhb_block_cyclic *f) {
  if (!f) return;
  shb_arena_free(&f->arena);
  free(f);
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

/* Rows of the next and the last system below block i, of `first` numbers. */
static double *below_of(const mhb_block_cyclic *f, int i) {
  return f->below + (size_t)i * (size_t)f->first * (2 * (size_t)f->size + 1);
}

/* Where a block is: own and after in the rows, before below the block eliminated before it. That of
 * the last row is in the last system. Blocks round the ring are in common with that system. */
mhb_cyclic_block mhb_block_cyclic_at(const mhb_block_cyclic *f, mhb_block_place which, int i) {
  const int end = f->blocks - 1, N = f->blocks;
  if (N == 1 || (i == end && which == MHB_BLOCK_OWN)) return (mhb_cyclic_block){f->last, f->beyond};
  if (which == MHB_BLOCK_OWN) return (mhb_cyclic_block){rows_of(f, i), f->width};
  if (which == MHB_BLOCK_AFTER && i < end)
    return (mhb_cyclic_block){rows_of(f, i) + f->first, f->width};
  if (which == MHB_BLOCK_BEFORE && i > 0) return (mhb_cyclic_block){below_of(f, i - 1), f->first};
  if (i == 0) return (mhb_cyclic_block){rows_of(f, 0) + f->first + n_next(f, 0), f->width};
  return (mhb_cyclic_block){below_of(f, 0) + n_next(f, 0) * f->first, f->first};
}

void mhb_block_cyclic_clear(mhb_block_cyclic *f) {
  const size_t N = (size_t)f->blocks, s = (size_t)f->size;
  memset(f->rows, 0, N * s * (size_t)f->width * sizeof(double));
  memset(f->below, 0, N * (2 * s + 1) * (size_t)f->first * sizeof(double));
  memset(f->last, 0, (s + 1) * (size_t)f->beyond * sizeof(double));
  memset(f->column, 0, N * s * sizeof(double));
  memset(f->row, 0, N * s * sizeof(double));
  f->corner = 0;
}

static int *pivot_of(const mhb_block_cyclic *f, int i) {
  return f->pivot + (size_t)i * ((size_t)f->size + 1);
}

/* ---- dense kernels, row-major; rows have whole vectors, with zeros behind what is used ---- */

MHB_HOT static void swap_rows(int n, double *x, double *y) {
  for (int j = 0; j < n; j += MHB_LANES) {
    const mhb_lanes old = lanes_load(x + j);
    lanes_store(x + j, lanes_load(y + j));
    lanes_store(y + j, old);
  }
}

/* Rows below p of A[n][width] lose their column p, whole vectors at once. u: [whole lanes of n] */
MHB_INLINE void eliminate_column(int n, int p, int width, double *A, double *u) {
  const int    all = mhb_whole_lanes(n), from = (p + 1) / MHB_LANES * MHB_LANES;
  const double inverse = 1 / A[p * (width + 1)];
  memset(u, 0, sizeof *u * (size_t)(p + 1)); /* what is eliminated already stays */
  memcpy(u + p + 1, A + p * (width + 1) + 1, sizeof *u * (size_t)(all - p - 1));
  for (int i = p + 1; i < n; i++) {
    double      *to = A + i * width;
    const double by = to[p] * inverse;
    to[p]           = by;
    for (int j = from; j < all; j += MHB_LANES)
      lanes_store(to + j, lanes_load(to + j) - by * lanes_load(u + j));
  }
}

/* Gaussian elimination of the first n columns of A[n][width], with row exchanges in all columns.
 * The sign of the determinant; 0: singular. */
MHB_HOT static int eliminate_rows(int n, int width, double *A, int *pivot) {
  double u[mhb_whole_lanes(n)];
  int    sign = 1;
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
    eliminate_column(n, p, width, A, u);
  }
  return sign;
}

/* a . x over whole vectors, two running sums at a time. */
MHB_INLINE double dot(int n, const double *a, const double *x) {
  mhb_half_lanes sum[2] = {{0}};
  for (int j = 0; j < n; j += MHB_LANES)
    for (int half = 0; half < 2; half++)
      sum[half] += half_lanes_load(a + j + half * MHB_HALF_LANES) *
                   half_lanes_load(x + j + half * MHB_HALF_LANES);
  const mhb_half_lanes all = sum[0] + sum[1];
  return (all[0] + all[2]) + (all[1] + all[3]);
}

/* x[n] <- A^-1 x with the factors in A[n][width]. y: [2][whole lanes of n] */
MHB_HOT static void solve_rows(int n, int width, const double *A, const int *pivot, double *x,
                               double *y) {
  const int all = mhb_whole_lanes(n);
  double   *z   = y + all;
  memset(y, 0, sizeof *y * 2 * (size_t)all); /* what is not solved yet counts as zero */
  for (int p = 0; p < n; p++) {
    const double old = x[p];
    x[p]             = x[pivot[p]];
    x[pivot[p]]      = old;
  }
  for (int i = 0; i < n; i++) y[i] = x[i] - dot(mhb_whole_lanes(i), A + i * width, y);
  for (int i = n - 1; i >= 0; i--) {
    const double *row  = A + i * width;
    const int     from = (i + 1) / MHB_LANES * MHB_LANES;
    z[i]               = (y[i] - dot(all - from, row + from, z + from)) / row[i];
  }
  memcpy(x, z, sizeof *x * (size_t)n);
}

/* y[rows] -= A x, A[rows][columns] with rows of width; columns in whole vectors. */
MHB_HOT static void subtract_from(int rows, int columns, int width, const double *A,
                                  const double *x, double *y) {
  for (int i = 0; i < rows; i++) y[i] -= dot(columns, A + i * width, x);
}

/* Products and substitutions by tiles, which all registers hold: 16 of four numbers (AVX2), or 32
 * of eight (AVX-512). Both add up in the same order. */
#define TILES(name) name
#define TILE_HOT MHB_HOT
#define TILE_LANES MHB_HALF_LANES
#define TILE_ROWS 4
#define tile_lanes mhb_half_lanes
#define tile_load half_lanes_load
#define tile_store half_lanes_store
#include "mhb/numerics/block_tiles.h"
#ifdef MHB_HAS_WIDE
#define TILES(name) wide_##name
#define TILE_HOT MHB_WIDE
#define TILE_LANES MHB_LANES
#define TILE_ROWS 8
#define tile_lanes mhb_lanes
#define tile_load lanes_load
#define tile_store lanes_store
#include "mhb/numerics/block_tiles.h"
#else
#define wide_substitute_rows substitute_rows
#define wide_multiply multiply
#endif

/* ---- factors ---- */

/* The border beside the blocks. */
static void set_border(mhb_block_cyclic *f) {
  const int s = f->size, end = f->blocks - 1;
  for (int i = 0; i < end; i++) {
    const int next   = n_next(f, i);
    double   *common = rows_of(f, i) + f->first, *below = below_of(f, i);
    for (int j = 0; j < s; j++) common[j * f->width + next + s] = f->column[i * s + j];
    memcpy(below + (next + s) * f->first, f->row + i * s, sizeof(double) * (size_t)s);
  }
  for (int j = 0; j < s; j++) f->last[j * f->beyond + s] = f->column[end * s + j];
  memcpy(f->last + s * f->beyond, f->row + end * s, sizeof(double) * (size_t)s);
  f->last[s * (f->beyond + 1)] = f->corner;
}

/* to[rows][columns] -= a part of the product, from its row and column. */
MHB_HOT static void subtract_part(const mhb_block_cyclic *f, int row, int column, int rows,
                                  int columns, int width, double *restrict to) {
  for (int i = 0; i < rows; i++) {
    const double *restrict from = f->product + (row + i) * f->width + column;
    for (int j = 0; j < columns; j++) to[i * width + j] -= from[j];
  }
}

/* Columns that meet block i solved for, and times the rows below it. */
static void multiply_through(mhb_block_cyclic *f, int i, int all) {
  const int s = f->size, width = f->width, columns = mhb_whole_lanes(all);
  double   *rows = rows_of(f, i), *common = rows + f->first;
  if (mhb_has_wide()) {
    wide_substitute_rows(s, width, f->first, columns, rows);
    wide_multiply(all, columns, s, f->first, width, below_of(f, i), common, f->product);
  } else {
    substitute_rows(s, width, f->first, columns, rows);
    multiply(all, columns, s, f->first, width, below_of(f, i), common, f->product);
  }
}

/* Eliminate block i: the next one and the last system lose it. 0: singular. */
static int eliminate(mhb_block_cyclic *f, int i) {
  const int s = f->size, w = s + f->borders, next = n_next(f, i), all = n_common(f, i);
  const int sign = eliminate_rows(s, f->width, rows_of(f, i), pivot_of(f, i));
  f->sign *= sign;
  if (!sign) return 0;
  multiply_through(f, i, all);
  subtract_part(f, next, next, w, w, f->beyond, f->last);
  if (next == 0) return 1;
  const int beyond = n_next(f, i + 1);
  double   *to     = rows_of(f, i + 1);
  subtract_part(f, 0, 0, s, s, f->width, to);
  subtract_part(f, 0, s, s, w, f->width, to + f->first + beyond);
  subtract_part(f, s, 0, w, s, f->first, below_of(f, i + 1) + beyond * f->first);
  return 1;
}

int mhb_block_cyclic_factor(mhb_block_cyclic *f, int borders) {
  const int end = f->blocks - 1, w = f->size + borders;
  f->borders = borders;
  f->sign    = 1;
  if (borders) set_border(f);
  for (int i = 0; i < end; i++)
    if (!eliminate(f, i)) return 0;
  f->sign *= eliminate_rows(w, f->beyond, f->last, pivot_of(f, end));
  return f->sign != 0;
}

/* ---- solutions ---- */

void mhb_block_cyclic_solve(mhb_block_cyclic *f, double *rhs) {
  const int    s = f->size, w = s + f->borders, end = f->blocks - 1;
  const size_t one = sizeof(double) * (size_t)s;
  double      *x   = f->padded;
  memcpy(f->x, rhs + (size_t)end * (size_t)s, sizeof(double) * (size_t)w);
  memset(x, 0, sizeof(double) * (size_t)f->width);
  for (int i = 0; i < end; i++) {
    const int next = n_next(f, i);
    double   *y    = rhs + (size_t)i * (size_t)s;
    solve_rows(s, f->width, rows_of(f, i), pivot_of(f, i), y, f->work);
    memcpy(x, y, one);
    subtract_from(next, f->first, f->first, below_of(f, i), x, y + s);
    subtract_from(w, f->first, f->first, below_of(f, i) + next * f->first, x, f->x);
  }
  solve_rows(w, f->beyond, f->last, pivot_of(f, end), f->x, f->work);
  memcpy(rhs + (size_t)end * (size_t)s, f->x, sizeof(double) * (size_t)w);
  for (int i = end - 1; i >= 0; i--) {
    const int next = n_next(f, i), columns = mhb_whole_lanes(next + w);
    double   *y = rhs + (size_t)i * (size_t)s;
    memcpy(x, y + s, sizeof(double) * (size_t)next);
    memcpy(x + next, f->x, sizeof(double) * (size_t)w);
    memset(x + next + w, 0, sizeof(double) * (size_t)(columns - next - w));
    subtract_from(s, columns, f->width, rows_of(f, i) + f->first, x, y);
  }
}
