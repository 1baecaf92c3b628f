/* The phases of the modal stage: time and memory of all ranks, told and kept in the modal file. */
#ifndef MODAL_COMMON_PHASES_H
#define MODAL_COMMON_PHASES_H

#include <hdf5.h>
#include <mpi.h>

#include "mesh/base/progress.h"
#include "mesh/base/status.h"

/* shb_progress_phase over all ranks, each of which keeps the same figures: the slowest one's seconds, processor seconds and
 * memory added up, the greatest memory of a rank. Collective; progress on every rank or NULL on every one. */
void modal_phase(MPI_Comm comm, shb_progress *progress, const char *name, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Writes /phases/{name, seconds, cpu, memory, greatest_memory} [phase] and its attribute ranks, with the phase under way, which is
 * called name, as it is now on this rank. Nothing where progress is NULL. */
shb_status modal_phases_write(hid_t file, int ranks, const shb_progress *progress,
                              const char *name);

#endif
