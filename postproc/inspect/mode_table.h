/* Table of the modes of a modal file: frequency, damping, share of the mass. */
#ifndef POSTPROC_INSPECT_MODE_TABLE_H
#define POSTPROC_INSPECT_MODE_TABLE_H

#include <hdf5.h>
#include <stdbool.h>

#include "mesh/base/status.h"
#include "modal/model/model.h"
#include "postproc/draw/text_buffer.h"

/* Write a line for each mode, the first 24 unless all. Effective masses are shares of the mass,
 * with their sums, if the file holds them. Errors: SHB_ERR_INPUT effective masses of another shape;
 * SHB_ERR_IO no memory. */
shb_status post_mode_table(hid_t file, const modal_model *model, bool all, post_buffer *out);

#endif
