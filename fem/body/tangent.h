/* A rotating body under large displacements: forces out of balance and tangent stiffness, assembled.
 *
 * Equilibrium in the rotating frame: F(u) = Omega^2 P M (X + u), with F the internal forces of fem/element/finite_strain.h. The
 * load follows the displacement, so that the tangent is K_T(u) - Omega^2 P M, symmetric. */
#ifndef FEM_BODY_TANGENT_H
#define FEM_BODY_TANGENT_H

#include "fem/body/assemble.h"
#include "fem/body/rotation.h"

/* What is assembled; nothing is owned. */
typedef struct {
  const mesh_fe      *mesh;
  const fem_material *material; /* one, or one a region */
  const fem_element  *element;
  fem_rotation        rotation;
  double              pressure; /* Pa, steady, on group load, into the deformed surface */
} fem_body;

/* Coordinates and displacements of an element's nodes, m: [n][3]. u: [n_nodes][3], NULL for none. */
void fem_body_element(const fem_body *body, int element, const double *u, double x[][3],
                      double v[][3]);

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
