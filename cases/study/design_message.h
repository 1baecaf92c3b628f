/* The result of a design as bytes, from the process that computed it to the manager. */
#ifndef CASES_STUDY_DESIGN_MESSAGE_H
#define CASES_STUDY_DESIGN_MESSAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "postproc/study/design_study.h"

/* Pack state, values, errors, derivatives, reason, seconds and curve. bytes: malloc'ed. Errors:
 * SHB_ERR_IO. */
shb_status design_message_pack(const study_design *design, int n_outputs, int n_derivatives,
                               char **bytes, size_t *size);

/* Unpack into a design with as many outputs and derivatives. Errors: SHB_ERR_IO cut, or no
 * memory. */
shb_status design_message_unpack(const char *bytes, size_t size, int n_outputs, int n_derivatives,
                                 study_design *design);

/* Give a design the result of another with equal inputs, which cost nothing. Errors: SHB_ERR_IO. */
shb_status design_message_copy(const study_design *from, int n_outputs, int n_derivatives,
                               study_design *to);

#endif
