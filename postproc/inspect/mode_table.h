/* The modes of a modal file as a table: frequency, damping, and the share of the mass that each carries. */
#ifndef POSTPROC_INSPECT_MODE_TABLE_H
#define POSTPROC_INSPECT_MODE_TABLE_H

#include <hdf5.h>
#include <stdbool.h>

#include "mesh/base/status.h"
#include "modal/model/model.h"
#include "postproc/draw/text_buffer.h"

/* One line a mode, the first 24 unless all; effective masses as shares of the mass in the file, and their sums over all modes of the
 * file, where it holds them. Errors: SHB_ERR_INPUT effective masses of another shape; SHB_ERR_IO no memory. */
shb_status post_mode_table(hid_t file, const modal_model *model, bool all, post_buffer *out);

#endif
