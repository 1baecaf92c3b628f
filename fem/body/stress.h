/* Nodal stresses and clamp forces of a body in static equilibrium, on one rank from the whole
 * displacement. */
#ifndef FEM_BODY_STRESS_H
#define FEM_BODY_STRESS_H

#include <petscsys.h>

#include "fem/body/rotating_body.h"

enum { FEM_STRESSES = 6 }; /* xx, yy, zz, xy, yz, xz, as VTK orders a symmetric tensor */

/* Cauchy stresses at the nodes, Pa: [n_nodes][6].
 *
 * In each element a linear function is fitted to the quadrature points by least squares and
 * evaluated at the nodes. A node gets the mean of its elements, weighted by volume. The error is of
 * second order in the element size; linear stress fields are exact. Where materials meet the value
 * is a mean of both.
 *   u  in  [n_nodes][3] m
 * Errors: PETSC_ERR_MEM. */
PetscErrorCode fem_nodal_stress(const fem_body *body, const double *u,
                                double (*stress)[FEM_STRESSES]);

/* Internal forces less loads at every node, clamped ones included, N. They vanish in equilibrium at
 * free nodes. At clamped nodes they are the clamp forces.
 *   unbalanced  out  [n_nodes][3]
 *   load        out  [3] resultant of the loads */
PetscErrorCode fem_unbalanced_forces(const fem_body *body, const double *u, double (*unbalanced)[3],
                                     double load[3]);

#endif
