/* The modal stage as a program runs it: mesh file in, modal file out. */
#ifndef MODAL_STAGE_STAGE_H
#define MODAL_STAGE_STAGE_H

#include "mesh/base/publish.h"
#include "modal/stage/solve.h"

/* The whole stage: rank 0 reads mesh_path, all solve, rank 0 publishes out_path (untouched on failure).
 * On failure the text is at least on rank 0. */
shb_status modal_stage(MPI_Comm comm, const char *mesh_path, const char *out_path,
                       const modal_settings *settings, const shb_provenance *provenance,
                       shb_progress *progress);

#endif
