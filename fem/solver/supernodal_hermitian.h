/* Solves with CHOLMOD's complex supernodal factor for four right-hand sides at once: the complex
 * form of fem/solver/supernodal_solve.h. CHOLMOD's own solve copies the factor for BLAS, and takes
 * three times as long on four columns. */
#ifndef FEM_SOLVER_SUPERNODAL_HERMITIAN_H
#define FEM_SOLVER_SUPERNODAL_HERMITIAN_H

#include "fem/solver/supernodal_solve.h"

/* One complex number of each right-hand side. */
typedef struct {
  fem_lanes re, im;
} fem_complex_lanes;

/* Rows of the largest supernode. */
size_t fem_supernodal_hermitian_rows(const cholmod_factor *L);

/* Solve L L^H x = b in place, in the order of the factor.
 *   L     in       supernodal, numeric, int, complex
 *   x     in/out   [n]
 *   work  scratch  [fem_supernodal_hermitian_rows] */
void fem_supernodal_solve_hermitian(const cholmod_factor *L, fem_complex_lanes *x,
                                    fem_complex_lanes *work);

#endif
