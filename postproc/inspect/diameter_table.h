/* Table of the frequencies of a sector with a disc over its nodal diameters. */
#ifndef POSTPROC_INSPECT_DIAMETER_TABLE_H
#define POSTPROC_INSPECT_DIAMETER_TABLE_H

#include <hdf5.h>
#include <stdbool.h>

#include "modal/model/nodal_diameters.h"
#include "postproc/draw/text_buffer.h"

/* Write a line for each mode, the first 24 unless all, with a column for each nodal diameter. Eight
 * columns make a block. A line tells whether a mode may be missing. Errors: SHB_ERR_IO. */
shb_status post_diameter_table(hid_t file, const modal_nodal_diameters *diameters, bool all,
                               post_buffer *out);

#endif
