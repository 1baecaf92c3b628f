/* shroudhb inspect: what an HDF5 file holds, first in a sentence, then where it came from, then its tree. */
#ifndef POSTPROC_INSPECT_INSPECT_H
#define POSTPROC_INSPECT_INSPECT_H

#include "mesh/base/status.h"
#include "postproc/draw/text_buffer.h"
#include "postproc/inspect/h5_tree.h"

/* Any HDF5 file; one that is not ours is said to be foreign. verbose: case text and settings in full.
 * Errors: SHB_ERR_IO missing, not HDF5, truncated (out stays empty); SHB_ERR_INPUT a file that claims to be of a
 * format of ours and is not (out is complete all the same, and the message says what is wrong). */
shb_status post_inspect(const char *path, post_tree_style style, post_buffer *out);

#endif
