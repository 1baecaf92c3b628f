/* A sector with as many modes at every nodal diameter as modal.modes: auto finds. */
#ifndef MODAL_STAGE_SECTOR_MODES_H
#define MODAL_STAGE_SECTOR_MODES_H

#include "modal/stage/sector_solve.h"

/* modal_solve and modal_sector_solve at one speed. With settings->modes 0 the number begins with
 * what nodal diameter 0 needs and grows until all keep the tolerance; all have the same number.
 *   result, sector  out  to be freed in any case
 * Errors: as theirs; SHB_ERR_INPUT no number of modes keeps the tolerance. */
shb_status modal_sector_solve_enough(MPI_Comm comm, const mesh_fe *mesh,
                                     const modal_settings *settings, shb_progress *progress,
                                     modal_result *result, modal_sector *sector);

#endif
