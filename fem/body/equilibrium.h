/* Static equilibrium of the clamped body under its centrifugal load and a steady pressure, large displacements included.
 *
 * Omega^2 and the pressure are raised to their full values in steps, one if it can be. In each, Newton's method on R(u) = 0 of
 * fem/body/tangent.h: the first direction comes from the tangent of the step before (a predictor), the others from the exact
 * one, by conjugate gradients on a Cholesky factor that is kept as long as it serves, in the first place that of
 * the body at rest. The length of a Newton step is the least potential along it, exactly: a St. Venant-Kirchhoff body's
 * potential is a quartic along a line (of a pressure that follows the surface, with its slope in the place of the potential's). A tangent that is not positive definite (beyond what the body can bear, or with
 * too large a step) and Newton steps that do not settle halve the load step. */
#ifndef FEM_BODY_EQUILIBRIUM_H
#define FEM_BODY_EQUILIBRIUM_H

#include "fem/body/assemble.h"
#include "fem/body/rotating_body.h"
#include "mesh/base/progress.h"

typedef struct {
  double *displacement;   /* [n_nodes][3] m, mesh axes; the same on every rank */
  int     steps;          /* load steps that converged */
  int     iterations;     /* Newton iterations, those of failed steps included */
  int     factorisations; /* Cholesky factors made */
  int     solves;         /* applications of a factor */
  double
      correction; /* last Newton correction, relative to the displacement (greatest components) */
} fem_equilibrium;

/* Solve; system->K, on entry the stiffness at rest (fem_system_create), becomes the tangent at the equilibrium, spin
 * softening included.
 * Errors: PETSC_ERR_USER_INPUT no equilibrium found (load step and speed named); PETSC_ERR_MEM.
 * If shb_interrupted(), stops early with displacement = NULL and no error. Collective. */
PetscErrorCode fem_equilibrium_solve(const fem_body *body, fem_system *system,
                                     shb_progress *progress, fem_equilibrium *out);

void fem_equilibrium_free(fem_equilibrium *equilibrium); /* also on a zeroed struct */

#endif
