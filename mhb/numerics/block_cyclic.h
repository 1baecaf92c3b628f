/* Direct solution of block-cyclic tridiagonal systems, with a border.
 *
 * Row of blocks i:  before_i x_{i-1} + own_i x_i + after_i x_{i+1} + column_i sigma = rhs_i,
 * border:           sum_i row_i . x_i + corner sigma = rhs_border,
 * i modulo the number of blocks N. LU by blocks eliminates x_0 .. x_{N-2}. The last block, the
 * coupling round the ring and the border are one dense system of size s + 1. With its pivots the
 * system may be singular without its border, as at a fold. Rows are exchanged inside blocks only.
 * Small blocks are no work for BLAS: the columns that meet a block are solved for and multiplied in
 * tiles that registers hold. Cost 12.7 N s^3 operations, memory 8 N s^2 numbers. */
#ifndef MHB_NUMERICS_BLOCK_CYCLIC_H
#define MHB_NUMERICS_BLOCK_CYCLIC_H

#include "mesh/base/arena.h"
#include "mesh/base/status.h"

typedef struct {
  int       blocks, size;         /* N >= 1, s >= 1; N may be lowered before the blocks are set */
  double   *before, *own, *after; /* [N][s][s] row-major */
  double   *column, *row;         /* [N][s] */
  double    corner;               /* of the border */
  int       borders;              /* 0 or 1: of the last factors */
  int       first, width;         /* of the rows below, in whole vectors */
  double   *rows;    /* [N][s][width] factors of a block; from `first` on own^-1 times the columns
                           * of the next and the last system */
  double   *below;   /* [N][2s+1][s] rows of the next and the last system */
  double   *product; /* [2s+1][width] */
  double   *last;    /* [s+1][s+1] */
  double   *x;       /* [s+1] */
  int      *pivot;   /* [N][s+1] */
  int       sign;    /* of the determinant of the last factors */
  shb_arena arena;
} mhb_block_cyclic;

/* SHB_ERR_IO: no memory. */
shb_status mhb_block_cyclic_create(int blocks, int size, mhb_block_cyclic **system);
void       mhb_block_cyclic_destroy(mhb_block_cyclic *system);

/* All blocks and the border <- 0. */
void mhb_block_cyclic_clear(mhb_block_cyclic *system);

/* Block [s][s], row-major. */
static inline double *mhb_block_cyclic_at(const mhb_block_cyclic *system, double *blocks, int i) {
  return blocks + (size_t)i * (size_t)system->size * (size_t)system->size;
}

/* Factor the blocks, with the border if borders is 1. 0: singular. No allocation. */
int mhb_block_cyclic_factor(mhb_block_cyclic *system, int borders);

/* rhs[N s or N s + 1] <- solution. No allocation. */
void mhb_block_cyclic_solve(mhb_block_cyclic *system, double *rhs);

#endif
