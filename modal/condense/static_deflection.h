/* The static deflection of the rotating blade: how the contact and the probes move under the centrifugal load and the steady pressure, with the
 * contact faces free. */
#ifndef MODAL_CONDENSE_STATIC_DEFLECTION_H
#define MODAL_CONDENSE_STATIC_DEFLECTION_H

#include "fem/body/equilibrium.h"
#include "modal/condense/condense.h"
#include "modal/condense/contact_patches.h"
#include "modal/condense/static_results.h"

typedef struct {
  double          speed, pressure; /* rad/s, Pa; both 0: nothing else is set */
  fem_equilibrium at;              /* displacement [n_nodes][3] m, and how it was found */
  double         *contact; /* [n_contact] m, mean displacement of the patches, cylindrical axes */
  double         *probe;   /* [3 q] m, cylindrical axes */
  double
      *closing; /* [pair] m: motion of the right face against the left one along its outward normal,
                              all blades alike; kv times it is the interference load of the shroud */
  double *
      stress; /* [n_elements] Pa, greatest von Mises stress of each element (rank 0; NULL elsewhere) */
  modal_static_results statics;                                /* rank 0; zero elsewhere */
  double               greatest_displacement, greatest_stress; /* m; Pa */
} modal_deflection;

/* Solve the equilibrium (fem_equilibrium_solve) and sample it. system->K becomes the tangent there.
 * Errors: those of fem_equilibrium_solve; SHB_ERR_INPUT a stress above a tenth of E; SHB_ERR_IO no memory; SHB_INTERRUPTED. Collective. */
shb_status modal_deflection_solve(const fem_body *body, fem_system *system,
                                  const modal_condensation *to, const modal_patches *patches,
                                  shb_progress *progress, modal_deflection *out);

/* Writes the root attributes rotor_speed, rotor_pressure and, unless both are 0, the group /static; modal_model_write comes first. */
shb_status modal_deflection_write(hid_t file, const modal_deflection *deflection, int n_nodes,
                                  int n_elements, const modal_model *model);

void modal_deflection_free(modal_deflection *deflection); /* also on a zeroed struct */

#endif
