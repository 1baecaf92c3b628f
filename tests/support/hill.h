/* Hill's method: multipliers from the derivative of the balance alone. A cross-check of floquet.h, not a replacement.
 *
 * Disturbances exp(st) sum_k a_k exp(jkwt) of the modes, k = -m..m, of nodal diameter d about the wave:
 *   [(s + jkw)^2 + 2 zeta_i w_i (s + jkw) + w_i^2] a_k + B_k^H sum_l P_kl B_l a_l = 0,   P = (I + J R)^-1 J
 *   B_k = right - exp(-j(2 pi d/N + k phi)) left,   J = d force/d motion of the contact law, in exponentials
 * J knows the slider only as it is in the periodic motion: with friction the multipliers are biased, at any number of harmonics; their
 * side of the unit circle is mostly right. Without friction they converge with m. */
#ifndef TESTS_SUPPORT_HILL_H
#define TESTS_SUPPORT_HILL_H

#include <complex.h>

#include "mhb/structure/modal_structure.h"

/* The 2 modes multipliers of nodal diameter d (0 for a blade on the ground), by falling modulus.
 *   omega  in  rad/s, of the fundamental
 *   dp     in  [pair][3 (2m+1)][3 (2m+1)] of mhb_contact_force, row-major, real form
 * Errors: SHB_ERR_IO no memory; SHB_NOT_CONVERGED the eigensolver failed. Cost: the cube of 2 modes (2m+1). */
shb_status hill_multipliers(const mhb_modal_structure *structure, int d, double omega, int m,
                            const double *dp, double complex *multiplier);

#endif
