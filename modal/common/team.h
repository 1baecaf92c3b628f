/* Ranks that share one machine work as threads of the first of them.
 *
 * The first rank takes the processors of all; the others wait asleep. The numbers are then those of
 * one process, and its factor is faster than MUMPS, which ranks would need. PETSc's
 * -mat_mumps_use_omp_threads gathers ranks in the same way for the factor alone. */
#ifndef MODAL_COMMON_TEAM_H
#define MODAL_COMMON_TEAM_H

#include <mpi.h>
#include <stdbool.h>

#include "mesh/base/status.h"

typedef struct {
  MPI_Comm all;      /* every rank */
  MPI_Comm comm;     /* the ranks that work */
  bool     works;    /* this rank is one of them */
  bool     gathered; /* only the first of several is */
  int      threads;  /* of this rank */
} modal_team;

/* Gather the ranks, unless
 *
 *   - they are on several machines,
 *   - the mesh has so many nodes that one process may not index its factor,
 *   - -st_pc_factor_mat_solver_type mumps is given, or
 *   - OpenMP binds threads: it has bound them to the processors of their rank.
 *
 * Collective, before the first rank starts threads.
 *   nodes  in  of the mesh, on the first rank
 * Errors: SHB_ERR_IO. */
shb_status modal_team_gather(MPI_Comm all, int nodes, modal_team *team);

/* Ends the wait of the others. Collective.
 *   status  in  of a rank that works
 * Returns it, on every rank. */
shb_status modal_team_end(const modal_team *team, shb_status status);

#endif
