/* Condensation of a sector at one nodal diameter: modal/condense/condense.h with complex shapes.
 *
 * With B = C^H b of the contact dofs, the terms R = B^H V_0, B^H V_1, B^H V_2 are Hermitian: row =
 * motion, column = force. A dof on a cyclic side counts with its neighbour's phase. */
#ifndef MODAL_CYCLIC_WAVE_CONDENSE_H
#define MODAL_CYCLIC_WAVE_CONDENSE_H

#include "modal/condense/condense.h"
#include "modal/cyclic/wave_modes.h"
#include "modal/model/nodal_diameters.h"

/* X[:, c] = C^H b_(first + c) for c < count; the other of the columns are zeroed. */
void wave_spread(const wave_operator *op, const modal_dofs *dofs, int first, int count, int columns,
                 double complex *X);

/* Fill model, imaginary and backward of modal/model/nodal_diameters.h, zeroed first, except probe
 * names, interfaces, normals and areas. backward is left zero where the load is real, both where
 * the wave is. Errors: SHB_INTERRUPTED. */
shb_status wave_condense(wave_operator *op, const wave_modes *modes, const modal_condensation *to,
                         modal_model *model, modal_model *imaginary, modal_model *backward);

#endif
