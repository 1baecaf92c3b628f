/* Phases of the modal stage: time and memory over all ranks, printed and written to the modal
 * file. */
#ifndef MODAL_COMMON_PHASES_H
#define MODAL_COMMON_PHASES_H

#include <hdf5.h>
#include <mpi.h>

#include "mesh/base/progress.h"
#include "mesh/base/status.h"

/* End a phase over all ranks. Every rank records the same figures: seconds of the slowest rank,
 * processor seconds and memory summed, and the largest memory of one rank. Collective; progress is
 * given on every rank or NULL on every rank. */
void modal_phase(MPI_Comm comm, shb_progress *progress, const char *name, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Write /phases/{name, seconds, cpu, memory, greatest_memory} [phase] and the attribute ranks. The
 * current phase, called name, is written as it stands on this rank. Nothing is written if progress
 * is NULL. */
shb_status modal_phases_write(hid_t file, int ranks, const shb_progress *progress,
                              const char *name);

#endif
