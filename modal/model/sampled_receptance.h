/* The receptance of the contact dofs at many frequencies, for readers of the modal file. */
#ifndef MODAL_MODEL_SAMPLED_RECEPTANCE_H
#define MODAL_MODEL_SAMPLED_RECEPTANCE_H

#include "modal/model/model.h"

/* Write /receptance/frequency [201 + m] Hz: even steps from 0 to 1.1 times the highest mode, and
 * the modes' own. Write /receptance/contact [201 + m][n_contact][n_contact], and error [201 + m].
 * Nothing is written above 64 MB. */
shb_status modal_sampled_write(hid_t file, const modal_model *model);

/* The same of a file that holds them, after a change of the damping. */
shb_status modal_sampled_replace(hid_t file, const modal_model *model);

#endif
