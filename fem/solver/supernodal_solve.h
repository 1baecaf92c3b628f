/* Solves with CHOLMOD's supernodal factor for four right-hand sides at once.
 *
 * A solve costs as much as reading the factor. Four columns take as long as one. CHOLMOD's own
 * solve calls BLAS on a few columns and takes twice as long; from twelve columns it is faster. */
#ifndef FEM_SOLVER_SUPERNODAL_SOLVE_H
#define FEM_SOLVER_SUPERNODAL_SOLVE_H

#include <stddef.h>
#include <suitesparse/cholmod.h>

enum { FEM_LANES = 4 };

/* One number of each right-hand side. */
typedef double fem_lanes __attribute__((vector_size(8 * FEM_LANES)));

/* Rows of the largest supernode. */
size_t fem_supernodal_rows(const cholmod_factor *L);

/* Solve L L^T x = b in place, in the order of the factor.
 *   L     in       supernodal, numeric, int
 *   x     in/out   [n]
 *   work  scratch  [fem_supernodal_rows] */
void fem_supernodal_solve(const cholmod_factor *L, fem_lanes *x, fem_lanes *work);

#endif
