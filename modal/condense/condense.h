/* Condensation of the body to its contact, probe and load dofs: modal shapes there, and what the modes left out
 * add to every receptance between them: residual flexibility, of order w^0, and residual inertia, of order w^2. */
#ifndef MODAL_CONDENSE_CONDENSE_H
#define MODAL_CONDENSE_CONDENSE_H

#include "fem/element/load.h"
#include "modal/common/damping.h"
#include "modal/condense/dofs.h"
#include "modal/condense/load_patterns.h"
#include "modal/eigen/eigen.h"
#include "modal/model/model.h"

/* What to condense to. contact: (side * n_pairs + pair) * 3 + axis; probe: 3 a probe. */
typedef struct {
  int           n_pairs;
  bool          has_left;
  modal_dofs    contact, probe;
  modal_load    load;
  modal_damping damping;
} modal_condensation;

/* Fill model (zeroed before): frequency, damping_ratio, right, left, residual_flexibility, residual_inertia, residual_fourth, moment_fourth, moment_fifth,
 * modal_force, load_residual, load_inertia, probe, probe_contact_residual, probe_contact_inertia, probe_load_residual,
 * probe_load_inertia, eigen_residual. With P = I - phi phi^T M, b a column of the contact dofs or the load and a one of
 * the contact or probe dofs, the modes left out, which are not damped, answer by
 *   sum_left out (a phi)(phi b)/(lambda - w^2) = a^T P [K^-1 + w^2 K^-1 M P K^-1 + O(w^4)] b:
 *   residual = a^T P K^-1 b            = a^T [K^-1 - sum phi phi^T / lambda] b
 *   inertia  = a^T P K^-1 M P K^-1 b   = a^T [K^-1 M K^-1 - sum phi phi^T / lambda^2] b
 * and, of the contact alone, whose error is what shifts a resonance,
 *   fourth   = a^T P K^-1 M P K^-1 M P K^-1 b
 * With y = P K^-1 M P K^-1 b and z = P K^-1 M y its moments mu_4 = y^T M y and mu_5 = z^T M y of every contact dof (modal/model/residual_series.h).
 * Collective; every rank gets the model. Errors: SHB_ERR_IO no memory, solver; SHB_INTERRUPTED. */
shb_status modal_condense(const fem_system *system, const modal_eigen *eigen,
                          const modal_condensation *to, shb_progress *progress, modal_model *model);

#endif
