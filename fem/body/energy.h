/* Energy of displacement fields, element by element from the strains. */
#ifndef FEM_BODY_ENERGY_H
#define FEM_BODY_ENERGY_H

#include "fem/body/rotating_body.h"

enum { FEM_FIELDS = 10 }; /* fields that share the shape gradients of an element */

/* Quadratic form u^T K u of n displacement fields, J; K is that of fem_tangent_assemble at a state.
 *
 * It is the integral of lambda (tr e)^2 + 2 mu e:e + h S:h, with h = du/dX and e = sym(F^T h).
 * Rotation subtracts Omega^2 u^T M P u; the pressure adds its term. Quadrature is as in
 * fem_element_stiffness. A product with the assembled K loses log10(lambda_max / lambda) digits, as
 * the rigid motion of each element cancels. Strains do not, so Rayleigh quotients keep about 13
 * digits. On all threads, whose number changes no bit.
 *   state   in   [n_nodes][3] m, zero at clamped nodes; NULL: at rest
 *   u       in   [n][n_nodes][3] m, zero at clamped nodes
 *   energy  out  [n] J */
void fem_tangent_energies(const fem_body *body, const double *state, int n, const double *u,
                          double *energy);

#endif
