/* The numbers of a supernodal Cholesky factor that CHOLMOD has analysed: left-looking, panel by panel, on one thread.
 *
 * CHOLMOD's own routine does the same, but copies with four OpenMP threads that wait for each other in between: on a machine
 * that is busy, or has fewer cores, those take more processor time than the arithmetic.
 * Source: Ng, Peyton, Block sparse Cholesky algorithms on advanced uniprocessor computers, SIAM J. Sci. Comput. 14, 1993. */
#ifndef FEM_PANELS_H
#define FEM_PANELS_H

#include <stdbool.h>
#include <suitesparse/cholmod.h>

/* A = L L^T.
 *   L  in/out  supernodal, int; symbolic, or numeric of an earlier A with the same pattern
 *   A  in      lower triangle, in L's order, real, packed
 *   *definite  out  false: A is not positive definite, and L holds no factor
 * False: no memory. */
bool fem_panels_fill(cholmod_factor *L, const cholmod_sparse *A, bool *definite,
                     cholmod_common *common);

#endif
