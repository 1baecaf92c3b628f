/* Residual and tangent stiffness of a rotating body under large displacements.
 *
 * Equilibrium in the rotating frame is F(u) = Omega^2 P M (X + u), with the internal forces F of
 * fem/element/finite_strain.h. The load follows the displacement. The tangent is K_T(u) - Omega^2 P
 * M, which is symmetric. */
#ifndef FEM_BODY_TANGENT_H
#define FEM_BODY_TANGENT_H

#include "fem/body/assemble.h"
#include "fem/body/rotating_body.h"

/* Residual R = F(u) - Omega^2 P M (X + u) - f_p(u) at the free dofs, N; f_p of fem/body/pressure.h.
 * Each rank computes the elements that touch its rows; nothing is sent.
 *   u  in  [n_nodes][3] m, the same on every rank, zero at clamped nodes */
PetscErrorCode fem_residual_assemble(const fem_body *body, const fem_system *system,
                                     const double *u, Vec R);

/* system->K = dR/du at u, of the pressure the symmetric part, in the pattern of
 * fem_system_create. */
PetscErrorCode fem_tangent_assemble(const fem_body *body, const double *u, fem_system *system);

/* Largest von Mises stress at the quadrature points of each element, Pa: [n_elements]. */
void fem_body_stress(const fem_body *body, const double *u, double *stress);

#endif
