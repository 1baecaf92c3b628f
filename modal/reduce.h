/* A modal model with fewer modes: what a coarser modal basis would have given. */
#ifndef MODAL_REDUCE_H
#define MODAL_REDUCE_H

#include <stdbool.h>

#include "modal/model.h"

/* Keep the lowest modes only, in place.
 *
 *   modes      1 to model->n_modes
 *   residuals  true: the modes left out answer statically, as if the file had been made with fewer of them:
 *              residual flexibility += sum phi phi^T/w^2, inertia += sum phi phi^T/w^4, fourth += sum phi phi^T/w^6, and so for load and probes (eqs. 34, 35);
 *              false: they are gone, and the residual parts of the file too
 * With all modes and residuals nothing changes.
 * Errors: SHB_ERR_INPUT modes out of range, SHB_ERR_IO no memory (the model is then still to be freed, and no longer of use). */
shb_status modal_model_keep(modal_model *model, int modes, bool residuals);

#endif
