/* The modal stage at several speeds: one equilibrium, one set of modes, one condensation each; modes tracked by their MAC. */
#ifndef MODAL_STAGE_SPEED_RANGE_H
#define MODAL_STAGE_SPEED_RANGE_H

#include "modal/model/speeds.h"
#include "modal/stage/solve.h"

/* modal_solve at each of settings->speeds, ascending; with modes: auto as many modes at every speed as the lowest or the highest needs. MAC = (phi^T M psi)^2 of all modes of neighbouring speeds, the greatest first, each
 * mode taken once; signs continue along the tracks.
 *   speeds  out  models of every speed, the one of settings->speed shared with result (modal_speed_range_free)
 *   result  out  of settings->speed, as modal_solve gives it, but for the factor, which is gone
 * Collective. Errors: as modal_solve. Both are to be freed in any case. */
shb_status modal_speed_range_solve(MPI_Comm comm, const mesh_fe *mesh,
                                   const modal_settings *settings, shb_progress *progress,
                                   modal_speeds *speeds, modal_result *result);

/* Frees speeds, but not what is result's. Call before modal_result_free. */
void modal_speed_range_free(modal_speeds *speeds, const modal_result *result);

#endif
