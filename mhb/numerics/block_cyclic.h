/* Direct solution of block-cyclic tridiagonal systems, with a border.
 *
 * Row of blocks i:  before_i x_{i-1} + own_i x_i + after_i x_{i+1} + column_i sigma = rhs_i,
 * border:           sum_i row_i . x_i + corner sigma = rhs_border,
 * i modulo the number of blocks N. LU by blocks eliminates x_0 .. x_{N-2}. The last block, the
 * coupling round the ring and the border are one dense system of size s + 1. With its pivots the
 * system may be singular without its border, as at a fold. Rows are exchanged inside blocks only.
 * Small blocks are no work for BLAS: the columns that meet a block are solved for and multiplied in
 * tiles that registers hold. Cost 12.7 N s^3 operations, memory 5 N s^2 numbers. */
#ifndef MHB_NUMERICS_BLOCK_CYCLIC_H
#define MHB_NUMERICS_BLOCK_CYCLIC_H

#include "mesh/base/arena.h"
#include "mesh/base/status.h"

typedef struct {
  int       blocks, size; /* N >= 1, s >= 1; N may be lowered before the system is cleared */
  double   *column, *row; /* [N][s] */
  double    corner;       /* of the border */
  int       borders;      /* 0 or 1: of the last factors */
  int       first, width; /* of the rows below, in whole vectors */
  int       beyond;       /* of a row of the last system, likewise */
  double   *rows;    /* [N][s][width] blocks, then their factors; from `first` on the columns of the
                         * next and the last system, then own^-1 times these */
  double   *below;   /* [N][2s+1][first] rows of the next and the last system */
  double   *product; /* [2s+1][width] */
  double   *last;    /* [s+1][beyond] */
  double   *x;       /* [s+1] */
  double   *padded;  /* [width] a vector with zeros behind it */
  double   *work;    /* [2][beyond] */
  int      *pivot;   /* [N][s+1] */
  int       sign;    /* of the determinant of the last factors */
  shb_arena arena;
} mhb_block_cyclic;

/* A block before, on or after the diagonal. */
typedef enum { MHB_BLOCK_BEFORE, MHB_BLOCK_OWN, MHB_BLOCK_AFTER } mhb_block_place;

/* [s][s], row-major, with rows of `stride`. */
typedef struct {
  double *at;
  int     stride;
} mhb_cyclic_block;

mhb_block_cyclic *mhb_block_cyclic_create(int blocks, int size);
void              mhb_block_cyclic_destroy(mhb_block_cyclic *system);

/* All blocks and the border <- 0. Factors take the blocks' place: clear before each. */
void mhb_block_cyclic_clear(mhb_block_cyclic *system);

/* A block of row i in a system that was cleared: add to it. With one or two blocks some are at the
 * same place. */
mhb_cyclic_block mhb_block_cyclic_at(const mhb_block_cyclic *system, mhb_block_place which, int i);

/* Factor the blocks, with the border if borders is 1. 0: singular. No allocation. */
int mhb_block_cyclic_factor(mhb_block_cyclic *system, int borders);

/* rhs[N s or N s + 1] <- solution. No allocation. */
void mhb_block_cyclic_solve(mhb_block_cyclic *system, double *rhs);

#endif
