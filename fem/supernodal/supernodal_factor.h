/* Numeric factorisation A = L L^T by panels, on all threads.
 *
 * Left-looking: a panel collects the updates of earlier panels in their order, so the numbers do
 * not depend on the number of threads. Each thread takes the next panel, or a whole subtree, and
 * waits for the panels that it needs. BLAS should run on one thread. Free of PETSc. */
#ifndef FEM_SUPERNODAL_SUPERNODAL_FACTOR_H
#define FEM_SUPERNODAL_SUPERNODAL_FACTOR_H

#include "fem/supernodal/block_order.h"
#include "fem/supernodal/supernodes.h"

/* Bytes of workspace on that many threads. */
double fem_supernodal_workspace(const fem_supernodes *s, int threads);

/* Factorise a symmetric matrix of 3x3 blocks. Returns false if it is not positive definite.
 *   block  in   [block][9] upper triangle in the order of the pattern, each block by columns
 *   only   in   [n_panels] panels that are wanted, with all below them in the tree; NULL: all
 *   value  out  [n_values] */
bool fem_supernodal_factorise(const fem_supernodes *s, const fem_lower_pattern *lower,
                              const double *block, const bool *only, double *value);

#endif
