/* Stresses at the nodes and forces at the clamp, of a body in static equilibrium. On one rank, from the whole displacement. */
#ifndef FEM_BODY_STRESS_H
#define FEM_BODY_STRESS_H

#include <petscsys.h>

#include "fem/body/rotating_body.h"

enum { FEM_STRESSES = 6 }; /* xx, yy, zz, xy, yz, xz, as VTK orders a symmetric tensor */

/* Cauchy stresses at the nodes, Pa: [n_nodes][6]. In each element the linear function that fits its quadrature points best (least
 * squares) is taken to its nodes; a node has the mean of its elements, by their volumes. Second order in the
 * element's size; exact where the stress is linear in space (where materials meet: a mean of theirs).
 *   u  in  [n_nodes][3] m
 * Errors: PETSC_ERR_MEM. */
PetscErrorCode fem_nodal_stress(const fem_body *body, const double *u,
                                double (*stress)[FEM_STRESSES]);

/* Forces out of balance at every node, clamped ones too: internal forces less the loads, N. In equilibrium they vanish
 * at free nodes; at clamped ones they are what the clamp exerts on the body.
 *   balance  out  [n_nodes][3]
 *   load     out  [3] resultant of the loads */
PetscErrorCode fem_unbalanced_forces(const fem_body *body, const double *u, double (*unbalanced)[3],
                                     double load[3]);

#endif
