/* Table of time and memory of the phases of the modal stage. */
#ifndef POSTPROC_INSPECT_PHASE_TABLE_H
#define POSTPROC_INSPECT_PHASE_TABLE_H

#include <hdf5.h>

#include "mesh/base/status.h"
#include "postproc/draw/text_buffer.h"

/* Write a line for each phase and one for all; nothing if the file holds no phases
 * (docs/user/files.md). Errors: SHB_ERR_INPUT columns of different lengths; SHB_ERR_IO no
 * memory. */
shb_status post_phase_table(hid_t file, post_buffer *out);

#endif
