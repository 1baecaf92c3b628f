/* Factor of a symmetric positive definite matrix: choice of the program, and the memory it needs.
 *
 * One rank: CHOLMOD (fem/solver/cholesky.h), whose solves are twice as fast as MUMPS's. MUMPS
 * serves several ranks (modal/common/team.h has when there are some), a factor too large for
 * CHOLMOD, and the option -st_pc_factor_mat_solver_type mumps. It takes the options
 * -st_mat_mumps_.... */
#ifndef FEM_SOLVER_FACTOR_H
#define FEM_SOLVER_FACTOR_H

#include <petscksp.h>
#include <stdbool.h>

#include "fem/supernodal/unit_loads.h"

typedef struct fem_factor fem_factor;

/* Is -st_pc_factor_mat_solver_type mumps given? */
PetscErrorCode fem_factor_mumps_asked(bool *yes);

/* Order and analyse the pattern of A. Collective, as all functions below.
 *   A       in  SBAIJ, block size 3
 *   beside  in  bytes that will be needed besides the factor, sum of all ranks
 * Errors: PETSC_ERR_USER_INPUT this machine lacks the memory; the text gives the bytes needed, the
 * bytes left and the remedy. */
PetscErrorCode fem_factor_create(Mat A, double beside, fem_factor **out);

/* Factorise A; may be repeated after its values have changed.
 *   definite  out  false: A is not positive definite, and there may be no factor
 * Errors: PETSC_ERR_MEM. */
PetscErrorCode fem_factor_update(fem_factor *factor, Mat A, bool *definite);

/* Solve A x = b; A X = B for all columns of a dense matrix. */
PetscErrorCode fem_factor_solve(fem_factor *factor, Vec b, Vec x);
PetscErrorCode fem_factor_solve_many(fem_factor *factor, Mat B, Mat X);

/* The same where only the rows of some nodes are wanted; cheaper on one rank.
 *   node  in   [block rows of this rank] true: wanted; the other rows of X mean nothing */
PetscErrorCode fem_factor_solve_at(fem_factor *factor, const bool *node, Mat B, Mat X);

/* The factor of one rank by panels; false: MUMPS holds it. */
bool fem_factor_tree(const fem_factor *factor, fem_tree *tree);

/* Make pc apply the factor to one vector or many. The factor must outlive pc. */
PetscErrorCode fem_factor_set_pc(fem_factor *factor, PC pc);

/* Bytes of the factor and its making from the analysis, all ranks; name of the program. */
double      fem_factor_bytes(const fem_factor *factor);
const char *fem_factor_program(const fem_factor *factor);

/* May solves read the matrix again that was factorised? MUMPS's own refinement does. */
bool fem_factor_needs_matrix(const fem_factor *factor);

PetscErrorCode fem_factor_destroy(fem_factor **factor); /* NULL: nothing */

#endif
