/* A modal model with fewer modes: what a coarser modal basis would have given. */
#ifndef MODAL_MODEL_REDUCE_H
#define MODAL_MODEL_REDUCE_H

#include <stdbool.h>

#include "modal/model/model.h"

/* Keep the lowest modes only, in place.
 *
 *   modes      1 to model->n_modes
 *   residuals  true: the modes left out answer by the residual terms (R += sum phi phi^T/w^2, R2 += sum phi phi^T/w^4, and so on, eqs. 34, 35), and, where
 *              R3 is there, as residual modes: as themselves, but for their damping; false: they are gone, and all of that too
 * With all modes and residuals nothing changes.
 * Errors: SHB_ERR_INPUT modes out of range, SHB_ERR_IO no memory (the model is then still to be freed, and no longer of use). */
shb_status modal_model_reduce(modal_model *model, int modes, bool residuals);

/* The three terms alone: residual modes go into their tail, which is of third order then. */
void modal_model_drop_residual_modes(modal_model *model);

#endif
