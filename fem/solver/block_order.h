/* Order of the nodes for CHOLMOD, and the calls of CHOLMOD that real and complex factors share. */
#ifndef FEM_SOLVER_BLOCK_ORDER_H
#define FEM_SOLVER_BLOCK_ORDER_H

#include <stdbool.h>
#include <suitesparse/cholmod.h>

/* Upper triangle of a symmetric pattern of 3x3 blocks, by block rows. */
typedef struct {
  int        n;
  const int *start, *column; /* [n + 1], [start[n]] */
} fem_blocks;

/* cholmod_start with the settings of this program. */
void fem_cholmod_start(cholmod_common *common);

/* Nested dissection of the graph of the nodes. It is three times smaller than that of the dofs and
 * as good.
 *   place  out  [n] index of a block row in the factor
 * Returns false when out of memory. */
bool fem_block_order(const fem_blocks *b, cholmod_common *common, int *place);

/* Column starts of the permuted lower triangle. In block column b the blocks below the diagonal
 * follow the diagonal block.
 *   next   scratch  [n], zero on entry and exit
 *   start  out      [3 n + 1] */
void fem_block_starts(const fem_blocks *b, const int *place, int *next, int *start);

/* Symbolic supernodal factorisation in the order given. NULL when out of memory or too large. */
cholmod_factor *fem_cholmod_analyse(cholmod_sparse *A, cholmod_common *common);

/* Factorise on one thread. CHOLMOD copies panels with four OpenMP threads that wait for each other.
 * On a busy machine this takes more processor time than the arithmetic. With no active levels its
 * parallel regions have one thread. */
void fem_cholmod_factorise(cholmod_sparse *A, cholmod_factor *L, cholmod_common *common);

#endif
