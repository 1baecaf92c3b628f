/* Energy of a displacement field, element by element from the strains. */
#ifndef FEM_BODY_ENERGY_H
#define FEM_BODY_ENERGY_H

#include "fem/body/rotating_body.h"

enum { FEM_FIELDS = 10 }; /* that share the gradients of an element */

/* u^T K u (twice the strain energy, J) of nodal displacements [n_nodes][3], with the quadrature of
 * fem_element_stiffness. The product with the assembled K loses log10(lambda_max / lambda) digits to the cancellation
 * of rigid motion inside each element; strains do not, so that Rayleigh quotients keep about 13 digits. */
double fem_strain_energy(const mesh_fe *mesh, const fem_material *material,
                         const fem_element *element, const double *u);

/* The same about a deformed state: u^T K u, K that of fem_tangent_assemble at the displacements state. With
 * h = du/dX and e = sym(F^T h): integral of lambda (tr e)^2 + 2 mu e:e + h S:h, less Omega^2 u^T M P u, and the pressure's.
 *   state, u  in  [n_nodes][3] m; zero at clamped nodes; state NULL: at rest */
double fem_tangent_energy(const fem_body *body, const double *state, const double *u);

/* energy[n] of n fields u[n][n_nodes][3], in one pass over the elements. */
void fem_tangent_energies(const fem_body *body, const double *state, int n, const double *u,
                          double *energy);

#endif
