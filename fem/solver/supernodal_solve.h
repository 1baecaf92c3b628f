/* Solves with CHOLMOD's supernodal factor for four right-hand sides at once.
 *
 * The factor is read once a sweep and that is what a solve costs: four take as long as one, where CHOLMOD's own, made of
 * calls to BLAS on a few columns, take twice as long. From a dozen columns on those are the faster ones. */
#ifndef FEM_SOLVER_SUPERNODAL_SOLVE_H
#define FEM_SOLVER_SUPERNODAL_SOLVE_H

#include <stddef.h>
#include <suitesparse/cholmod.h>

enum { FEM_LANES = 4 };

/* One number of each right-hand side. */
typedef double fem_lanes __attribute__((vector_size(8 * FEM_LANES)));

/* Rows of the largest supernode. */
size_t fem_supernodal_rows(const cholmod_factor *L);

/* L L^T x = b in place, in the factor's order.
 *   L     in      supernodal, numeric, int
 *   x     in/out  [n]
 *   work          [fem_supernodal_rows] */
void fem_supernodal_solve(const cholmod_factor *L, fem_lanes *x, fem_lanes *work);

#endif
