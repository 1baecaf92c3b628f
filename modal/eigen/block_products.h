/* Products of tall blocks of columns, on all threads. The numbers do not depend on the number of
 * threads: the rows are summed in parts that depend on their number alone. */
#ifndef MODAL_EIGEN_BLOCK_PRODUCTS_H
#define MODAL_EIGEN_BLOCK_PRODUCTS_H

#include <stdbool.h>
#include <stddef.h>

/* C_k = Q_k^T Y for n blocks.
 *   Q    in   [n], each [p][rows]
 *   Y    in   [p][rows]
 *   C    out  [n][p][p], C_k[c][a] of column a of Q_k and column c of Y */
void modal_block_inner(size_t rows, size_t p, size_t n, double *const *Q, const double *Y,
                       double *C);

/* W -= sum of Q_k C_k, with the same C.
 *   W  in/out  [p][rows] */
void modal_block_subtract(size_t rows, size_t p, size_t n, double *const *Q, const double *C,
                          double *W);

#endif
