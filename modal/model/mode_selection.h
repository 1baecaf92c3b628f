/* How many of a model's modes a tolerance of the contact receptance needs over a band. Free of PETSc. */
#ifndef MODAL_MODEL_MODE_SELECTION_H
#define MODAL_MODEL_MODE_SELECTION_H

#include "modal/model/model.h"

/* The fewest modes that, the others answering by residual terms and modes (modal/model/reduce.h), leave the receptance of the contact with an estimated error
 * (modal_series_error) of at most tolerance of its greatest diagonal value at every frequency from 0 to band (Hz; a hundred of them); and no mode
 * up to 1.2 band is left out.
 *   modes  out  0: the model has too few
 *   error  out  of those modes; of all of them if they are too few
 * Errors: SHB_ERR_INPUT a model without residual terms and their tail; SHB_ERR_IO no memory. */
shb_status modal_select_modes(const modal_model *model, double band, double tolerance, int *modes,
                              double *error);

#endif
