/* Nodal stresses and clamp forces of a body in static equilibrium, on one rank from the whole
 * displacement. */
#ifndef FEM_BODY_STRESS_H
#define FEM_BODY_STRESS_H

#include <complex.h>
#include <petscsys.h>

#include "fem/body/rotating_body.h"
#include "mesh/base/status.h"

enum { FEM_STRESSES = 6 }; /* xx, yy, zz, xy, yz, xz, as VTK orders a symmetric tensor */

/* Cauchy stresses at the nodes, Pa: [n_nodes][6].
 *
 * In each element a linear function is fitted to the quadrature points by least squares and
 * evaluated at the nodes. A node gets the mean of its elements, weighted by volume. The error is of
 * second order in the element size; linear stress fields are exact. Where materials meet, only the
 * elements of the stiffest material count (greatest E; of equal ones the first). On cyclic sides
 * the elements of both sectors count.
 *   u  in  [n_nodes][3] m */
void fem_nodal_stress(const fem_body *body, const double *u, double (*stress)[FEM_STRESSES]);

/* Change of these stresses by small motions about a state: their derivative along each motion. It
 * is rounded to single precision, 6e-8 relative.
 *   u       in   [n_nodes][3] m, the state; NULL: at rest
 *   motion  in   [n][n_nodes][3], mode shapes for example
 *   stress  out  [n][n_nodes][6], Pa for each metre of the motion */
void fem_nodal_stress_change(const fem_body *body, const double *u, int n, const double *motion,
                             float *stress);

/* Some motions and where their stresses go, as above. */
typedef struct {
  int           n;
  const double *motion;
  float        *stress;
} fem_motions;

/* The same for several sets of motions. Eight motions are a piece of work for a thread. */
void fem_nodal_stress_changes(const fem_body *body, const double *u, int n_sets,
                              const fem_motions *set);

/* The same of motions of a sector at one nodal diameter, the right side e^(-j theta) T times the
 * left. Free of PETSc: several threads may each work on a nodal diameter.
 *   phase   in   e^(-j theta) (fem/body/sector.h)
 *   motion  in   [n][n_nodes][3]
 *   stress  out  [n][n_nodes][6] */
void fem_nodal_stress_wave(const fem_body *body, const double *u, double complex phase, int n,
                           const double complex *motion, float complex *stress);

/* Internal forces less loads at every node, clamped ones included, N. They vanish in equilibrium at
 * free nodes. At clamped nodes they are the clamp forces.
 *   unbalanced  out  [n_nodes][3]
 *   load        out  [3] resultant of the loads */
PetscErrorCode fem_unbalanced_forces(const fem_body *body, const double *u, double (*unbalanced)[3],
                                     double load[3]);

#endif
