/* Static equilibrium of the clamped body under centrifugal load and steady pressure, with large
 * displacements.
 *
 * Omega^2 and the pressure rise in load steps, if possible in one. Each step solves R(u) = 0 of
 * fem/body/tangent.h by Newton's method. The first direction uses the tangent of the step before (a
 * predictor), the others the exact tangent. Linear systems are solved by conjugate gradients,
 * preconditioned with a Cholesky factor that is kept as long as it is efficient.
 *
 * The step length minimises the potential along the direction. The potential of a St.
 * Venant-Kirchhoff body is a quartic along a line. With a pressure that follows the surface, the
 * slope d . R takes its place. The load step is halved if the tangent is not positive definite or
 * Newton's method does not converge. */
#ifndef FEM_BODY_EQUILIBRIUM_H
#define FEM_BODY_EQUILIBRIUM_H

#include "fem/body/assemble.h"
#include "fem/body/rotating_body.h"
#include "mesh/base/progress.h"

typedef struct {
  double *displacement;   /* [n_nodes][3] m, mesh axes; the same on every rank */
  int     steps;          /* converged load steps */
  int     iterations;     /* Newton iterations, failed steps included */
  int     factorisations; /* Cholesky factors made */
  int     solves;         /* applications of a factor */
  double  correction;     /* last Newton correction divided by the displacement, maximum norms */
} fem_equilibrium;

/* Solve for the equilibrium. Collective.
 *   system  in/out  K: stiffness at rest (fem_system_create) on entry; on exit the tangent at the
 *                   equilibrium, spin softening included
 *   out     out     displacement NULL if interrupted (shb_interrupted), without an error
 * Errors: PETSC_ERR_USER_INPUT no equilibrium found; the message gives load step and speed.
 * PETSC_ERR_MEM. */
PetscErrorCode fem_equilibrium_solve(const fem_body *body, fem_system *system,
                                     shb_progress *progress, fem_equilibrium *out);

void fem_equilibrium_free(fem_equilibrium *equilibrium); /* also on a zeroed struct */

#endif
