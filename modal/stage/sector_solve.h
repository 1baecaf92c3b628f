/* Models of a sector with a disc at every nodal diameter wanted, one a thread. */
#ifndef MODAL_STAGE_SECTOR_SOLVE_H
#define MODAL_STAGE_SECTOR_SOLVE_H

#include "modal/cyclic/wave_fields.h"
#include "modal/model/nodal_diameters.h"
#include "modal/model/sector_speeds.h"
#include "modal/stage/solve.h"
#include "modal/stage/tracks.h"

typedef struct {
  modal_nodal_diameters models; /* model[0] is shared with the result of modal_solve */
  modal_check          *check;  /* [n] */
  wave_fields          *fields; /* [n], of the first zero */
  modal_sector_speeds   speeds; /* n = 0: one speed. Models of the main one are shared. */
} modal_sector;

/* Can a sector with these settings be solved? Errors: SHB_ERR_INPUT several ranks, modal.check:
 * inertia, a nodal diameter above N/2. */
shb_status modal_sector_check(MPI_Comm comm, const modal_settings *settings);

/* The nodal diameters wanted, ascending, with 0; their models are zero. */
void modal_sector_list(const modal_settings *settings, modal_nodal_diameters *models);

/* Add the other nodal diameters to that of 0; settings->modes is their number, not 0.
 *
 * The stiffness is that about the static equilibrium of nodal diameter 0. As many threads run as
 * OpenMP and the memory allow; the results do not depend on their number.
 *   first   in/out  modal_solve of the mesh on one rank; its factor is freed
 *   tracks  in/out  of several speeds; fields are then made at the main one only. NULL: one speed
 *   sector  out     freed by the caller in any case
 * Errors: as modal_solve. */
shb_status modal_sector_solve(const mesh_fe *mesh, const modal_settings *settings,
                              shb_progress *progress, modal_result *first,
                              modal_sector_tracks *tracks, modal_sector *sector);

/* Free all but the model shared with first. Call it before modal_result_free; also on a zeroed
 * struct. */
void modal_sector_free(modal_sector *sector, const modal_result *first);

#endif
