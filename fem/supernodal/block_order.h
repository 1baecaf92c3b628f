/* Order of the nodes and the pattern of the factor, by CHOLMOD. */
#ifndef FEM_SUPERNODAL_BLOCK_ORDER_H
#define FEM_SUPERNODAL_BLOCK_ORDER_H

#include <stdbool.h>
#include <suitesparse/cholmod.h>

/* Upper triangle of a symmetric pattern of 3x3 blocks, by block rows. */
typedef struct {
  int        n;
  const int *start, *column; /* [n + 1], [start[n]] */
} fem_blocks;

/* cholmod_start with the settings of this program. */
void fem_cholmod_start(cholmod_common *common);

/* Order the nodes by nested dissection, and factorise their pattern symbolically. It has a third of
 * the columns of the dofs' and a ninth of its entries; the order is as good.
 *   place  out  [n] index of a block row in the factor
 * Returns the supernodal factor of the nodes: each of its rows and columns is three of A. NULL: it
 * is too large for CHOLMOD's indices. */
cholmod_factor *fem_block_analyse(const fem_blocks *b, cholmod_common *common, int *place);

/* The permuted lower triangle by block columns. Block (r, c) is the block-th of the pattern, or the
 * transpose of it if block is ~ its index. */
typedef struct {
  int  n;           /* block columns */
  int *start;       /* [n + 1] */
  int *row, *block; /* [start[n]] */
} fem_lower_pattern;

void fem_lower_pattern_create(const fem_blocks *b, const int *place, fem_lower_pattern *out);
void fem_lower_pattern_free(fem_lower_pattern *lower);

#endif
