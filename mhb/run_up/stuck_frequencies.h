/* Natural frequencies of the ring with stuck contacts, for two diagrams: over the nodal diameter
 * (SAFE, ZZENF) and over the speed of the rotor (Campbell). The balance computes and stores them,
 * so that a page needs no solver. */
#ifndef MHB_RUN_UP_STUCK_FREQUENCIES_H
#define MHB_RUN_UP_STUCK_FREQUENCIES_H

#include <stdbool.h>

#include "modal/hdf5/h5.h"
#include "modal/model/sector_speeds.h"

enum { MHB_MOST_DRIVEN = 16 };

typedef struct mhb_diagrams {
  bool known; /* false: the file is of a version that stored none */
  /* over the nodal diameter; n_families = 0: the blade has no neighbour */
  int     n_families, n_diameters;
  int    *diameter;     /* [n_diameters] of those that a disc's file has */
  double *open, *stuck; /* [diameter][family] Hz */
  int     n_driven;     /* harmonics of the load with a force */
  int     driven[MHB_MOST_DRIVEN];
  bool    disc; /* the blades share a flexible disc */
  /* over the speed; n_stuck = 0: none */
  int     n_waves, n_speeds, n_stuck;
  int    *wave;  /* [n_waves] their nodal diameters */
  double *speed; /* [n_speeds] rad/s */
  double *over;  /* [wave][speed][n_stuck] Hz, rising */
} mhb_diagrams;

/* Indices of the nodal diameters of a disc's file that the load meets at engine order E, that of E
 * itself first.
 *   index  out  [sector->n]
 * Returns their number. */
int mhb_driven_diameters(const modal_sector_speeds *sector, int engine_order, int *index);

/* The groups /safe and /campbell, and the root attribute that tells that they were computed. */
shb_status mhb_diagrams_write(hid_t file, const mhb_diagrams *diagrams);
/* From the response file at path. Errors: SHB_ERR_INPUT lists that do not fit; SHB_ERR_IO. */
shb_status mhb_diagrams_read(const char *path, mhb_diagrams *diagrams);
void       mhb_diagrams_free(mhb_diagrams *diagrams);

#endif
