/* Modes and residual columns of a sector at one nodal diameter, at all its nodes, with their
 * stresses. */
#ifndef MODAL_CYCLIC_WAVE_FIELDS_H
#define MODAL_CYCLIC_WAVE_FIELDS_H

#include "modal/condense/condense.h"
#include "modal/cyclic/wave_modes.h"

/* All in mesh axes. A backward wave has the conjugates. */
typedef struct {
  int             n_modes, n_columns; /* columns: contact dofs, then load patterns; 0: none */
  double complex *shape;              /* [n_modes][n_nodes][3] kg^-1/2 */
  float complex  *stress;             /* [n_modes][n_nodes][6] Pa kg^-1/2 */
  float complex  *residual;           /* [n_columns][n_nodes][3] m/N */
  float complex  *residual_stress;    /* [n_columns][n_nodes][6] Pa/N */
} wave_fields;

/* Create them about the static displacement state (NULL: at rest).
 *
 * The residual columns are C P K^-1 C^H b, as modal/condense/residual_shapes.h has them.
 *   columns  in  whether they are wanted
 *   fields   out freed by the caller in any case */
void wave_fields_create(wave_operator *op, const wave_modes *modes, const modal_condensation *to,
                        const fem_body *body, const double *state, bool columns,
                        wave_fields *fields);
void wave_fields_free(wave_fields *fields); /* also on a zeroed struct */

#endif
