/* The blocks of a symmetric matrix (sequential SBAIJ, block size 3), looked at in place. */
#ifndef FEM_SOLVER_SBAIJ_BLOCKS_H
#define FEM_SOLVER_SBAIJ_BLOCKS_H

#include <petscmat.h>

/* Upper triangle by block rows. */
typedef struct {
  PetscInt        n;
  const PetscInt *start, *column;
  const double   *value; /* [block][9], each by columns */
} fem_blocks;

/* A must not change until the blocks are given back. */
PetscErrorCode fem_blocks_borrow(Mat A, fem_blocks *blocks);
PetscErrorCode fem_blocks_give_back(Mat A, fem_blocks *blocks);

#endif
