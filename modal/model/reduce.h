/* Reduction of a modal model to fewer modes. */
#ifndef MODAL_MODEL_REDUCE_H
#define MODAL_MODEL_REDUCE_H

#include <stdbool.h>

#include "modal/model/nodal_diameters.h"

/* Keep the lowest modes, in place.
 *
 *   modes      1 to model->n_modes
 *   residuals  true: modes left out add to the residual terms (R += sum phi phi^T/w^2,
 *              R2 += sum phi phi^T/w^4, ..., eqs. 34, 35). Where R3 exists they also become
 *              residual modes without damping.
 *              false: modes left out and all residual terms are dropped.
 *
 * With all modes and residuals the model is unchanged. Errors: SHB_ERR_INPUT modes out of range. */
shb_status modal_model_reduce(modal_model *model, int modes, bool residuals);

/* The same of a travelling wave, with phi phi^H for phi phi^T; imaginary and backward of
 * modal/model/nodal_diameters.h, both NULL of a real one. */
shb_status modal_wave_reduce(modal_model *model, modal_model *imaginary, modal_model *backward,
                             int modes, bool residuals);

/* The same at every nodal diameter of a disc. */
shb_status modal_nodal_diameters_reduce(modal_nodal_diameters *diameters, int modes,
                                        bool residuals);

/* Drop the residual modes. Their contribution moves into the tail, which is then of third order. */
void modal_model_drop_residual_modes(modal_model *model);
void modal_wave_drop_residual_modes(modal_model *model, modal_model *imaginary,
                                    modal_model *backward);

#endif
