/* Coriolis matrix of the modes of a sector at one nodal diameter.
 *
 * G is the mass matrix with 2 Omega [e]x in place of the identity. The rotation T of the cyclic
 * sides commutes with [e]x. Hence C^H G C = 2 Omega [e]x M(theta) row by row, and phi^H G phi
 * follows from M phi. Derivation: docs/theory/coriolis.md. */
#ifndef MODAL_CYCLIC_WAVE_CORIOLIS_H
#define MODAL_CYCLIC_WAVE_CORIOLIS_H

#include "fem/body/rotation.h"
#include "modal/cyclic/wave_modes.h"

/* re + j im [n][n] <- phi^H G phi, 1/s, skew-Hermitian: re is skew-symmetric and im symmetric; im
 * NULL: real shapes. */
void wave_coriolis(const wave_modes *modes, const fem_rotation *rotation, fem_turning turning,
                   double *re, double *im);

#endif
