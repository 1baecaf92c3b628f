/* Sign of the Jacobian determinant: inverted elements are found and straightened. */
#ifndef MESH_CORE_JACOBIAN_H
#define MESH_CORE_JACOBIAN_H

#include "mesh/core/fe_mesh.h"

/* Smallest det J of an element over its corners and quadrature points, m3. Quadrature points: the 4
 * of the second-order rule in a tetrahedron, 2x2x2 and 3x3x3 Gauss points in a hexahedron. */
double mesh_jacobian_least(const mesh_fe *mesh, int element);

/* Number of elements with det J <= 0. */
int mesh_jacobian_inverted(const mesh_fe *mesh);

/* Worst corner of all elements: det J divided by the lengths of the three edge tangents. The value
 * is 1 for a brick and 0 for a flat corner.
 *   x  out  coordinates of the corner, m */
double mesh_jacobian_worst_corner(const mesh_fe *mesh, double x[3]);

/* Straighten the edges of inverted elements: mid-side nodes move half way between their corners.
 * The pass is repeated for neighbours that this inverts, until no element is inverted or no node
 * moves.
 *   moved  in/out  [n_nodes] set to 1 for these nodes */
void mesh_jacobian_straighten(mesh_fe *mesh, char *moved);

/* SHB_ERR_INPUT if any element has det J <= 0. The message names up to five tags, and the most
 * frequent cause (mesh/core/inversion.h) with the place of an element, as the mesh has it.
 *   name  in  heads the message */
shb_status mesh_jacobian_check(const mesh_fe *mesh, const char *name);

#endif
