/* Where the time and the memory of the modal stage went, as a table. */
#ifndef POSTPROC_INSPECT_PHASE_TABLE_H
#define POSTPROC_INSPECT_PHASE_TABLE_H

#include <hdf5.h>

#include "mesh/base/status.h"
#include "postproc/draw/text_buffer.h"

/* One line a phase and one for all; nothing where the file holds none (docs/user/files.md,
 * /phases).
 * Errors: SHB_ERR_INPUT columns of different lengths; SHB_ERR_IO no memory. */
shb_status post_phases(hid_t file, post_buffer *out);

#endif
