/* A rotating body under large displacements: forces out of balance and tangent stiffness, assembled.
 *
 * Equilibrium in the rotating frame: F(u) = Omega^2 P M (X + u), with F the internal forces of fem/element/finite_strain.h. The
 * load follows the displacement, so that the tangent is K_T(u) - Omega^2 P M, symmetric. */
#ifndef FEM_BODY_TANGENT_H
#define FEM_BODY_TANGENT_H

#include "fem/body/assemble.h"
#include "fem/body/rotating_body.h"

/* R = F(u) - Omega^2 P M (X + u) - f_p(u), N, at the free dofs; f_p of fem/body/pressure.h.
 *   u  in  [n_nodes][3] m, the same on every rank, zero at clamped nodes
 * Nothing is sent: each rank computes the elements that touch its rows. */
PetscErrorCode fem_residual_assemble(const fem_body *body, const fem_system *system,
                                     const double *u, Vec R);

/* system->K = dR/du at u (of the pressure, the symmetric part), in the places that fem_system_create preallocated. */
PetscErrorCode fem_tangent_assemble(const fem_body *body, const double *u, fem_system *system);

/* Greatest von Mises stress of each element's quadrature points, Pa: [n_elements]. */
void fem_body_stress(const fem_body *body, const double *u, double *stress);

#endif
