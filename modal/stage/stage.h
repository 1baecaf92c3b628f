/* The modal stage from file to file: reads a mesh, writes the modal file. */
#ifndef MODAL_STAGE_STAGE_H
#define MODAL_STAGE_STAGE_H

#include "mesh/base/publish.h"
#include "modal/stage/solve.h"

/* Rank 0 reads mesh_path, the ranks solve, rank 0 publishes out_path, untouched on failure. Ranks
 * of one machine work as threads of rank 0 (modal/common/team.h). The error text is on rank 0 at
 * least. Errors: as modal_solve; SHB_ERR_IO files. */
shb_status modal_stage(MPI_Comm all, const char *mesh_path, const char *out_path,
                       const modal_settings *settings, const shb_provenance *provenance,
                       shb_progress *progress);

#endif
