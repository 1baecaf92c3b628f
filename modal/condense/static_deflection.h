/* Static deflection of the rotating blade: contact and probe displacements under centrifugal load
 * and steady pressure, with free contact faces. */
#ifndef MODAL_CONDENSE_STATIC_DEFLECTION_H
#define MODAL_CONDENSE_STATIC_DEFLECTION_H

#include "fem/body/equilibrium.h"
#include "modal/condense/condense.h"
#include "modal/condense/contact_patches.h"
#include "modal/condense/static_results.h"

/* closing is the displacement of the right face relative to the left one along its outward normal,
 * all blades alike. Times kv it is the interference load of the shroud. */
typedef struct {
  double          speed, pressure; /* rad/s, Pa; if both are 0 nothing else is set */
  fem_equilibrium at;              /* displacement [n_nodes][3] m, and solver counts */
  double         *contact; /* [n_contact] m, mean displacement of the patches, cylindrical axes */
  double         *probe;   /* [3 q] m, cylindrical axes */
  double         *closing; /* [pair] m */
  double         *stress;  /* [n_elements] Pa, largest von Mises stress; rank 0, NULL elsewhere */
  modal_static_results statics;                                /* rank 0; zero elsewhere */
  double               greatest_displacement, greatest_stress; /* m; Pa */
} modal_deflection;

/* Solve the equilibrium (fem_equilibrium_solve) and sample it. system->K becomes the tangent
 * stiffness there. Collective. Errors: those of fem_equilibrium_solve; SHB_ERR_INPUT a stress above
 * a tenth of E; SHB_INTERRUPTED. */
shb_status modal_deflection_solve(const fem_body *body, fem_system *system,
                                  const modal_condensation *to, const modal_patches *patches,
                                  shb_progress *progress, modal_deflection *out);

/* Write the root attributes rotor_speed, rotor_pressure and, unless both are 0, the group /static.
 * Call modal_model_write first. */
shb_status modal_deflection_write(hid_t file, const modal_deflection *deflection, int n_nodes,
                                  int n_elements, const modal_model *model);

void modal_deflection_free(modal_deflection *deflection); /* also on a zeroed struct */

#endif
