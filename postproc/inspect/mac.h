/* Two modal files against each other: frequencies, and whose mode shapes are alike.
 *
 *   MAC_ij = |a_i . b_j|^2 / (|a_i|^2 |b_j|^2)
 * a, b: the shapes at every node where both meshes have the same nodes, else what both files know of the same places: the
 * contact patches (as many pairs and sides, and where both files have coordinates, within a hundredth of their distance from the origin)
 * and the probes of the same names. Source: Allemang 2003. */
#ifndef POSTPROC_INSPECT_MAC_H
#define POSTPROC_INSPECT_MAC_H

#include <hdf5.h>
#include <stdbool.h>

#include "mesh/base/status.h"
#include "modal/model/model.h"
#include "postproc/draw/text_buffer.h"

typedef struct {
  int     n[2];   /* modes of each */
  int     values; /* that were compared */
  bool    nodes;  /* at every node; else condensed: */
  bool    contact;
  int     probes; /* common ones */
  double *mac;    /* [n[0]][n[1]] */
} post_mac;

/* Errors: SHB_ERR_INPUT nothing in common to compare; SHB_ERR_IO no memory. out is to be freed in any case. */
shb_status post_mac_create(const hid_t file[2], const modal_model model[2], post_mac *out);
void       post_mac_free(post_mac *mac);

/* The comparison of two files as text; all: the whole matrix, however large. Errors: also those of modal_model_read. */
shb_status post_compare(const char *const path[2], bool all, post_buffer *out);

#endif
