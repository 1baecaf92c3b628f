/* Mass and stiffness of the clamped body in PETSc matrices, on any number of ranks.
 *
 * The dofs of the nodes of group root are left out, so that K is positive definite. Block row r of K and M is
 * a free node, its three rows the mesh axes: dof = 3 row[node] + axis. Each rank owns the block rows
 * first .. last-1 and computes every element that touches them, so that nothing is sent during assembly. */
#ifndef FEM_BODY_ASSEMBLE_H
#define FEM_BODY_ASSEMBLE_H

#include <petscmat.h>

#include "fem/element/element.h"
#include "mesh/core/fe_mesh.h"

typedef struct {
  MPI_Comm  comm;
  int       n_nodes;     /* of the mesh */
  PetscInt  n_free;      /* free nodes, all ranks */
  PetscInt  first, last; /* block rows of this rank */
  PetscInt *row;         /* [n_nodes] block row, -1 for a clamped node; the same on every rank */
  Mat       K;           /* SBAIJ, block size 3, order 3 n_free; N/m */
  Mat       M;           /* MAIJ: one number a pair of nodes, times the 3x3 identity; kg */
} fem_system;

/* Assemble. mesh must be the same on every rank; material: one, or one a region (fem_material_at). */
PetscErrorCode fem_system_create(MPI_Comm comm, const mesh_fe *mesh, const fem_material *material,
                                 fem_rules rules, fem_system *system);

/* A = K - shift M, like K. */
PetscErrorCode fem_system_shifted(const fem_system *system, double shift, Mat *A);

/* Bring a distributed vector to rank 0 in mesh order, clamped nodes zero.
 *   nodal  out  [n_nodes][3] on rank 0; not touched elsewhere */
PetscErrorCode fem_system_gather(const fem_system *system, Vec x, double *nodal);

/* The same on every rank. */
PetscErrorCode fem_system_share(const fem_system *system, Vec x, double *nodal);

/* Where an element's blocks go: rows as PETSc wants them, the node's block row where it is this rank's, else -1
 * (ignored); columns, -1 for a clamped node; one a node of the element. False if the element touches no row of this rank. */
bool fem_system_rows(const mesh_fe *mesh, const fem_system *system, int element, PetscInt *rows,
                     PetscInt *columns);

PetscErrorCode fem_system_destroy(fem_system *system); /* also on a zeroed struct */

#endif
