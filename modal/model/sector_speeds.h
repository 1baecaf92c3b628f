/* Modal models of a sector with a disc at several rotor speeds. Free of PETSc.
 *
 * In the file: each group /nodal_diameter_n holds /speeds and /speed_0, /speed_1, ... as a clamped
 * blade's file does (speeds.h). The model of the group itself is that of one of the speeds. */
#ifndef MODAL_MODEL_SECTOR_SPEEDS_H
#define MODAL_MODEL_SECTOR_SPEEDS_H

#include "modal/model/nodal_diameters.h"
#include "modal/model/speeds.h"

typedef struct {
  int           blades;   /* N */
  int           n;        /* nodal diameters held; 0: one speed */
  int          *diameter; /* [n] ascending from 0 */
  modal_speeds *at;       /* [n] the same speeds at each */
} modal_sector_speeds;

/* Allocate n nodal diameters, all zero. */
void modal_sector_speeds_create(int blades, int n, modal_sector_speeds *speeds);

/* Write them to an open modal file that has the groups of the nodal diameters. */
shb_status modal_sector_speeds_write(hid_t file, const modal_sector_speeds *speeds);

/* Read them; n = 0 if the file has no nodal diameters, or one speed. Errors: as
 * modal_nodal_diameters_read; SHB_ERR_INPUT also if the models do not fit together, or if one has
 * no overlap. */
shb_status modal_sector_speeds_read(const char *path, modal_sector_speeds *speeds);

void modal_sector_speeds_free(modal_sector_speeds *speeds); /* also on a zeroed struct */

#endif
