/* Number of modes that a given accuracy of the contact receptance needs. Free of PETSc. */
#ifndef MODAL_MODEL_MODE_SELECTION_H
#define MODAL_MODEL_MODE_SELECTION_H

#include "modal/model/model.h"

/* Find the fewest modes for which the estimated error (modal_series_error) of the contact
 * receptance is at most tolerance, relative to its largest diagonal value. The modes left out
 * contribute by residual terms and residual modes (modal/model/reduce.h). The error is tested at
 * 100 frequencies from 0 to band, Hz. No mode up to 1.2 band is left out.
 *
 *   modes  out  0 if the model has too few
 *   error  out  of these modes; of all modes if they are too few
 *
 * Errors: SHB_ERR_INPUT a model without residual terms and their tail. */
shb_status modal_select_modes(const modal_model *model, double band, double tolerance, int *modes,
                              double *error);

/* Whether the modes of a nodal diameter are enough by the same rules.
 *   imaginary  in   imaginary parts of the model; NULL: real
 *   error      out  of the contact receptance, relative */
shb_status modal_modes_suffice(const modal_model *model, const modal_model *imaginary, double band,
                               double tolerance, bool *enough, double *error);

#endif
