/* Numbers of the complex panels of a Hermitian factor, on one thread.
 *
 * Left-looking, as supernodal_factor.h, whose real panels must be there. A product of complex
 * panels is four of real matrices. Free of PETSc. */
#ifndef FEM_SUPERNODAL_HERMITIAN_FACTOR_H
#define FEM_SUPERNODAL_HERMITIAN_FACTOR_H

#include "fem/supernodal/supernodal_factor.h"
#include "fem/supernodal/supernodal_hermitian.h"

/* The matrix: the lower triangle of its pattern, blocks [9] by columns. */
typedef struct {
  const fem_lower_pattern *lower;
  const double            *real;       /* [block][9] of blocks that are not coupled */
  const int               *coupled_at; /* [block] index in coupled, or -1 */
  const double             complex (*coupled)[9];
} fem_hermitian_blocks;

double fem_hermitian_workspace(const fem_supernodes *s); /* bytes */

/* Returns false if the matrix is not positive definite. */
bool fem_hermitian_factorise(const fem_hermitian_blocks *A, fem_hermitian_panels *panels);

#endif
