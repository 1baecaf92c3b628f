/* shroudhb inspect: contents of an HDF5 file as a summary, its origin, and its tree. */
#ifndef POSTPROC_INSPECT_INSPECT_H
#define POSTPROC_INSPECT_INSPECT_H

#include "mesh/base/status.h"
#include "postproc/draw/text_buffer.h"
#include "postproc/inspect/h5_tree.h"

/* Inspect any HDF5 file; foreign ones are named so. verbose: case text and settings in full.
 * Errors: SHB_ERR_IO missing, not HDF5, truncated (out stays empty); SHB_ERR_INPUT a file of a
 * format of ours with invalid contents (out is complete, the message names the fault). */
shb_status post_inspect(const char *path, post_tree_style style, post_buffer *out);

#endif
