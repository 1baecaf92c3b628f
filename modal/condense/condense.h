/* Condensation of the body to its contact, probe and load dofs. The mode shapes are sampled there.
 * Residual terms and residual modes stand for the modes left out. */
#ifndef MODAL_CONDENSE_CONDENSE_H
#define MODAL_CONDENSE_CONDENSE_H

#include "modal/condense/residual_terms.h"

/* Fill the model, zeroed first, except probe names, interfaces, normals and areas.
 *
 * P is the projector I - phi phi^T M. Column b belongs to a contact dof or to the load. Column a
 * belongs to a contact or probe dof. The modes left out, undamped, contribute
 *
 *   sum (a phi)(phi b)/(lambda - w^2) = a^T P [K^-1 + w^2 K^-1 M P K^-1 + O(w^4)] b,
 *   residual = a^T P K^-1 b                    = a^T [K^-1 - sum phi phi^T / lambda] b,
 *   inertia  = a^T P K^-1 M P K^-1 b           = a^T [K^-1 M K^-1 - sum phi phi^T / lambda^2] b,
 *   fourth   = a^T P K^-1 M P K^-1 M P K^-1 b.
 *
 * The tails hold the next two moments of each contact dof (modal/model/residual_series.h).
 * Collective; every rank gets the model. Errors: SHB_ERR_IO solver; SHB_INTERRUPTED. */
shb_status modal_condense(const fem_system *system, const modal_eigen *eigen,
                          const modal_condensation *to, shb_progress *progress, modal_model *model);

#endif
