/* Energy of a displacement field, element by element from the strains. */
#ifndef FEM_BODY_ENERGY_H
#define FEM_BODY_ENERGY_H

#include "fem/body/rotating_body.h"

enum { FEM_FIELDS = 10 }; /* that share the gradients of an element */

/* u^T K u of n displacement fields, J: twice the strain energy about a state, K that of fem_tangent_assemble at that state.
 *
 * With h = du/dX and e = sym(F^T h): integral of lambda (tr e)^2 + 2 mu e:e + h S:h, less
 * Omega^2 u^T M P u, plus the term of the pressure. Quadrature as in fem_element_stiffness.
 * The product with the assembled K loses log10(lambda_max / lambda) digits, since the rigid motion
 * of each element cancels there. Strains do not, so Rayleigh quotients keep about 13 digits.
 *   state   in   [n_nodes][3] m, zero at clamped nodes; NULL: at rest
 *   u       in   [n][n_nodes][3] m, zero at clamped nodes
 *   energy  out  [n] J */
void fem_tangent_energies(const fem_body *body, const double *state, int n, const double *u,
                          double *energy);

#endif
