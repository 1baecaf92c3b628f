/* Rotation about the engine axis at constant speed, in the rotating frame. Centrifugal load on the
 * deformed position and its derivative, the spin softening; Coriolis force of a motion. */
#ifndef FEM_BODY_ROTATION_H
#define FEM_BODY_ROTATION_H

#include "mesh/base/axes.h"

typedef struct {
  mesh_axis axis;  /* through the origin, along a mesh axis */
  double    speed; /* rad/s */
} fem_rotation;

/* Diagonal of Omega^2 P, P = I - a a^T, rad2/s2: Omega^2 across the engine axis a, 0 along it. */
void fem_rotation_square(const fem_rotation *rotation, double square[3]);

/* Consistent load of an element of n nodes, f_i = Omega^2 P sum_j m_ij (x_j + u_j), N.
 *   m     in   [n][n] kg, fem_element_mass
 *   x, u  in   [n][3] m, coordinates and displacements */
void fem_rotation_load(const fem_rotation *rotation, int n, const double *m, const double x[][3],
                       const double u[][3], double f[][3]);

/* K -= Omega^2 m_ij P, [3n][3n]: the load increases as the body moves outward. */
void fem_rotation_soften(const fem_rotation *rotation, int n, const double *m, double *K);

/* Towards which side the rotor turns, seen from a blade: left is -tangential. None: Coriolis forces
 * are left out. */
typedef enum { FEM_TURNS_UNSAID, FEM_TURNS_LEFT, FEM_TURNS_RIGHT } fem_turning;

/* force = 2 Omega x mv, N, of the momentum mv (kg m/s) in the rotating frame. It stands on the left
 * side of the equation of motion. */
void fem_rotation_coriolis(const fem_rotation *rotation, fem_turning turning, const double mv[3],
                           double force[3]);

#endif
