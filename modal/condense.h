/* Condensation of the body to its contact, probe and load dofs: modal shapes there, and what the modes left out
 * add to the receptance: residual flexibility, of order w^0, and residual
 * inertia, of order w^2. */
#ifndef MODAL_CONDENSE_H
#define MODAL_CONDENSE_H

#include "fem/load.h"
#include "modal/dofs.h"
#include "modal/eigen.h"
#include "modal/model.h"

/* What to condense to. contact: (side * n_pairs + pair) * 3 + axis; probe: 3 a probe; load: one dof, the work of
 * the load's pattern. */
typedef struct {
  int             n_pairs;
  bool            has_left;
  modal_dofs      contact, probe, load;
  const fem_load *excitation; /* factors of the harmonics */
  double          damping;    /* of every mode */
} modal_condensation;

/* Fill model (zeroed before): frequency, damping_ratio, right, left, residual_flexibility, residual_inertia,
 * modal_force, load_residual, probe, probe_contact_residual, probe_load_residual, mode_residual. With P = I - phi
 * phi^T M and b the contact dofs,
 *   residual_flexibility = b^T P K^-1 b            = b^T [K^-1 - sum phi phi^T / lambda] b
 *   residual_inertia     = b^T P K^-1 M P K^-1 b   = b^T [K^-1 M K^-1 - sum phi phi^T / lambda^2] b
 * Collective; every rank gets the model. Errors: SHB_ERR_IO no memory, solver; SHB_INTERRUPTED. */
shb_status modal_condense(const fem_system *system, const modal_eigen *eigen,
                          const modal_condensation *to, shb_progress *progress, modal_model *model);

#endif
