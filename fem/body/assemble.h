/* Mass and stiffness of the clamped body in PETSc matrices, on any number of ranks.
 *
 * The dofs of the nodes of group root are left out, so K is positive definite. Block row r of K and
 * M belongs to a free node; its three rows are the mesh axes: dof = 3 row[node] + axis. Each rank
 * owns the block rows first .. last - 1. It computes every element that touches them, so assembly
 * needs no communication.
 *
 * Of a sector (mesh->image) the nodes of cyclic_right have the block rows of their partners:
 * u_right = turn u_left. At the turn of the mesh this is nodal diameter 0. */
#ifndef FEM_BODY_ASSEMBLE_H
#define FEM_BODY_ASSEMBLE_H

#include <petscmat.h>

#include "fem/element/element.h"
#include "mesh/core/fe_mesh.h"

typedef struct {
  MPI_Comm  comm;
  int       n_nodes;     /* of the mesh */
  PetscInt  n_free;      /* number of free nodes, all ranks */
  PetscInt  first, last; /* block rows of this rank */
  PetscInt *row;         /* [n_nodes] block row, -1 for a clamped node; the same on every rank */
  Mat       K;           /* SBAIJ, block size 3, order 3 n_free; N/m. NULL: given up */
  Mat       M; /* MAIJ: one number a pair of nodes, times the 3x3 identity; of a sector SBAIJ; kg */
  bool     *turned;     /* [n_nodes] node that moves as turn times its partner; NULL: no sector */
  double    turn[3][3]; /* of a sector */
} fem_system;

/* Number the dofs and assemble K and M.
 *   mesh      in  the same on every rank
 *   material  in  one, or one a region (fem_material_at) */
PetscErrorCode fem_system_create(MPI_Comm comm, const mesh_fe *mesh, const fem_material *material,
                                 fem_rules rules, fem_system *system);

/* Work that needs the pattern of K and not its numbers. */
typedef struct {
  PetscErrorCode (*run)(const fem_system *system, void *context);
  void *context;
} fem_beside;

/* The same; on one rank the calling thread works beside, while others compute the elements.
 *   beside  in  NULL: nothing */
PetscErrorCode fem_system_create_beside(MPI_Comm comm, const mesh_fe *mesh,
                                        const fem_material *material, fem_rules rules,
                                        const fem_beside *beside, fem_system *system);

/* What the matrices are assembled of. */
typedef struct {
  const mesh_fe      *mesh;
  const fem_material *material;
  fem_rules           rules;
} fem_source;

/* K again, of a system that has lost it: the same numbers. */
PetscErrorCode fem_system_restore(const fem_source *from, fem_system *system);

/* A = K - shift M, in the format of K; the caller destroys it. */
PetscErrorCode fem_system_shifted(const fem_system *system, double shift, Mat *A);

/* Gather a distributed vector on rank 0 in mesh order; clamped nodes are zero.
 *   nodal  out  [n_nodes][3] on rank 0; not touched elsewhere */
PetscErrorCode fem_system_gather(const fem_system *system, Vec x, double *nodal);

/* Gather a distributed vector on every rank. */
PetscErrorCode fem_system_share(const fem_system *system, Vec x, double *nodal);

/* Block rows and columns of an element's nodes, -1 for a clamped node. rows holds -1 also for rows
 * of other ranks, which PETSc ignores. Returns false if the element touches no row of this rank.
 *   rows, columns  out  [nodes of an element] */
bool fem_system_rows(const mesh_fe *mesh, const fem_system *system, int element, PetscInt *rows,
                     PetscInt *columns);

/* Vector of a node in the frame of its block row: turn^T v at a turned node, else v itself. */
void fem_system_to_row(const fem_system *system, int node, const double v[3], double out[3]);

/* The inverse: motion of a node from that of its block row; out may be v. */
void fem_system_from_row(const fem_system *system, int node, const double v[3], double out[3]);

/* Bring the 3x3 blocks of n nodes to the frames of their block rows; nothing without turned nodes.
 *   K  in/out  [3n][3n] */
void fem_system_turn(const fem_system *system, int n, const int *node, double *K);

PetscErrorCode fem_system_destroy(fem_system *system); /* also on a zeroed struct */

#endif
