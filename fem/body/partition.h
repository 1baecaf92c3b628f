/* Distribution of the mesh to all ranks and of its free nodes among them. */
#ifndef FEM_BODY_PARTITION_H
#define FEM_BODY_PARTITION_H

#include <petscsys.h>
#include <stdbool.h>

#include "mesh/core/fe_mesh.h"

/* Copy the mesh of rank 0 to every rank; free it there with mesh_fe_free. */
PetscErrorCode fem_mesh_broadcast(MPI_Comm comm, mesh_fe *mesh);

/* Recursive coordinate bisection: equal numbers of free nodes a rank; the longest side of the
 * bounding box is cut first. The result depends on the mesh alone.
 *   is_free  in   [n_nodes]
 *   rank     out  [n_nodes], -1 where not free */
PetscErrorCode fem_partition(const mesh_fe *mesh, const bool *is_free, int n_ranks, int *rank);

#endif
