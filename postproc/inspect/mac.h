/* Comparison of two modal files: frequencies, and correlation of the mode shapes.
 *
 *   MAC_ij = |a_i . b_j|^2 / (|a_i|^2 |b_j|^2)
 *
 * a, b: shapes at every node if both meshes have the same nodes. Else they are the shapes at
 * contact patches (equal number of pairs and sides; coordinates, if given, equal within 1 %) and at
 * probes of equal name. Source: Allemang 2003. */
#ifndef POSTPROC_INSPECT_MAC_H
#define POSTPROC_INSPECT_MAC_H

#include <hdf5.h>
#include <stdbool.h>

#include "mesh/base/status.h"
#include "modal/model/model.h"
#include "postproc/draw/text_buffer.h"

typedef struct {
  int     n[2];   /* modes of each file */
  int     values; /* values compared */
  bool    nodes;  /* at every node; else at contact and probes */
  bool    contact;
  int     probes; /* common ones */
  double *mac;    /* [n[0]][n[1]] */
} post_mac;

/* Compute the MAC; out is freed by the caller in any case. Errors: SHB_ERR_INPUT nothing in common;
 * SHB_ERR_IO no memory. */
shb_status post_mac_create(const hid_t file[2], const modal_model model[2], post_mac *out);
void       post_mac_free(post_mac *mac);

/* Comparison of two files as text; all: the matrix at any size. Errors: also those of
 * modal_model_read. */
shb_status post_compare(const char *const path[2], bool all, post_buffer *out);

#endif
