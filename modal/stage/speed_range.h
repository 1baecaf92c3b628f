/* The modal stage at several speeds: one equilibrium, one set of modes and one condensation for
 * each. Modes are tracked by their MAC. */
#ifndef MODAL_STAGE_SPEED_RANGE_H
#define MODAL_STAGE_SPEED_RANGE_H

#include "modal/model/speeds.h"
#include "modal/stage/sector_solve.h"
#include "modal/stage/solve.h"

/* Call modal_solve at each of settings->speeds, ascending. With modal.modes: auto every speed gets
 * the larger number of modes needed at the lowest and the highest speed. Modes of neighbouring
 * speeds are matched by MAC = (phi^T M psi)^2, largest first, each mode once. Signs continue along
 * the tracks.
 *
 *   speeds  out  models of every speed; that of settings->speed is shared with result. With a
 *                sector it is empty: they are sector->speeds.at[0]
 *   sector  in/out  zeroed, of a sector with a disc, on one rank: all its nodal diameters at every
 *                speed, and their fields at settings->speed. NULL: a clamped blade
 *   result  out  modal_solve at settings->speed, without its factor
 *
 * Collective. Errors: as modal_solve. All outputs must be freed in any case. */
shb_status modal_speed_range_solve(MPI_Comm comm, const mesh_fe *mesh,
                                   const modal_settings *settings, shb_progress *progress,
                                   modal_speeds *speeds, modal_sector *sector,
                                   modal_result *result);

/* Free speeds, except for the model shared with result. Call it before modal_result_free. */
void modal_speed_range_free(modal_speeds *speeds, const modal_result *result);

#endif
