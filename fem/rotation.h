/* Rotation about the engine axis at a constant speed, in the rotating frame: the centrifugal load on the deformed
 * position and its derivative, the spin softening. Gyroscopic (Coriolis) terms are left out. */
#ifndef FEM_ROTATION_H
#define FEM_ROTATION_H

#include "mesh/axes.h"

typedef struct {
  mesh_axis axis;  /* through the origin, along a mesh axis */
  double    speed; /* rad/s */
} fem_rotation;

/* Omega^2 along the mesh axes across the engine axis, 0 along it, rad2/s2: the diagonal of Omega^2 P, P = I - a a^T. */
void fem_rotation_square(const fem_rotation *rotation, double square[3]);

/* Consistent load of an element, f_i = Omega^2 P sum_j m_ij (x_j + u_j), N.
 *   m     in   [10][10] kg, fem_tet10_mass
 *   x, u  in   [10][3] m, coordinates and displacements */
void fem_tet10_centrifugal(const fem_rotation *rotation, const double m[10][10],
                           const double x[10][3], const double u[10][3], double f[10][3]);

/* K -= Omega^2 m_ij P: the load grows where the body moves outward. */
void fem_tet10_soften(const fem_rotation *rotation, const double m[10][10], double K[30][30]);

#endif
