/* The sign of the Jacobian: inverted elements found, and straightened. */
#ifndef MESH_CORE_JACOBIAN_H
#define MESH_CORE_JACOBIAN_H

#include "mesh/core/fe_mesh.h"

/* Least det J [m3] of element e over its corners and quadrature points: the four of the second-order rule in a
 * tetrahedron, 2x2x2 and 3x3x3 Gauss points in a hexahedron. */
double mesh_jacobian_least(const mesh_fe *mesh, int element);

/* Elements with det J <= 0. */
int mesh_jacobian_inverted(const mesh_fe *mesh);

/* The sharpest corner of all elements: det J over the lengths of the three edges' tangents, 1 for a brick, 0 for a flat corner;
 * x out: where, m. */
double mesh_jacobian_worst_corner(const mesh_fe *mesh, double x[3]);

/* Put the mid-side nodes of inverted elements half way between their corners, again for any neighbour that
 * this inverts, until none is left or nothing moves; moved[n_nodes] is set to 1 for those nodes. */
void mesh_jacobian_straighten(mesh_fe *mesh, char *moved);

/* SHB_ERR_INPUT, naming up to five elements by tag, if any has det J <= 0; name heads the text. */
shb_status mesh_jacobian_check(const mesh_fe *mesh, const char *name);

#endif
