/* Numeric factorisation A = L L^T by panels, on all threads.
 *
 * Left-looking: a panel collects the updates of earlier panels in their order, so the numbers do
 * not depend on the number of threads. Each thread takes the next panel, or a whole subtree, and
 * waits for the panels that it needs. BLAS should run on one thread. Free of PETSc. */
#ifndef FEM_SOLVER_SUPERNODAL_FACTOR_H
#define FEM_SOLVER_SUPERNODAL_FACTOR_H

#include "fem/solver/supernodes.h"

/* Lower triangle of a symmetric matrix of 3x3 blocks, in the order of the factor, by block columns.
 * Block (r, c) is the block-th of value, by columns; its transpose if block is ~ its index. */
typedef struct {
  int           n;           /* block columns */
  const int    *start;       /* [n + 1] */
  const int    *row, *block; /* [start[n]] */
  const double *value;       /* [block][9] */
} fem_lower_blocks;

typedef enum { FEM_FACTORISED, FEM_NOT_DEFINITE, FEM_NO_MEMORY } fem_factorised;

/* Bytes of workspace on that many threads. */
double fem_supernodal_workspace(const fem_supernodes *s, int threads);

/*   value  out  [n_values] */
fem_factorised fem_supernodal_factorise(const fem_supernodes *s, const fem_lower_blocks *A,
                                        double *value);

#endif
