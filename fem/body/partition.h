/* The mesh on every rank, and its free nodes shared out among the ranks. */
#ifndef FEM_BODY_PARTITION_H
#define FEM_BODY_PARTITION_H

#include <petscsys.h>
#include <stdbool.h>

#include "mesh/core/fe_mesh.h"

/* Copy the mesh of rank 0 to every rank (elsewhere mesh is overwritten; free with mesh_fe_free). */
PetscErrorCode fem_mesh_broadcast(MPI_Comm comm, mesh_fe *mesh);

/* Recursive coordinate bisection: rank of each node, equal numbers of free nodes a rank, the longest side of
 * the bounding box cut first. Depends on the mesh alone, so every rank finds the same.
 *   is_free  in   [n_nodes]
 *   rank     out  [n_nodes], -1 where not free */
PetscErrorCode fem_partition(const mesh_fe *mesh, const bool *is_free, int n_ranks, int *rank);

#endif
