/* The tree of any HDF5 file: groups, datasets with type, shape, range, units, links. */
#ifndef POSTPROC_INSPECT_H5_TREE_H
#define POSTPROC_INSPECT_H5_TREE_H

#include <hdf5.h>
#include <stdbool.h>

#include "mesh/base/status.h"
#include "postproc/draw/text_buffer.h"

typedef struct {
  bool colour;  /* ANSI, for a terminal */
  bool verbose; /* every group of a numbered series, every attribute */
} post_tree_style;

/* Write a line for each object below the root. Of a numbered series of groups (branch_0, branch_1,
 * ...) only the first is shown in full unless verbose. Datasets are read in pieces of 2 MB;
 * unreadable ones are marked. Errors: SHB_ERR_IO no memory, a group that cannot be read. */
shb_status post_tree(hid_t file, post_tree_style style, post_buffer *out);

#endif
