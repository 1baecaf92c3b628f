/* Topology of gmsh's ten-node tetrahedron and the sign of its Jacobian. */
#ifndef MESH_TET10_H
#define MESH_TET10_H

#include "mesh/fe_mesh.h"

/* Ends of edge e, whose middle is local node 4 + e. */
extern const int mesh_tet10_edge[6][2];

/* Local nodes of face f as a six-node triangle (3 corners, then mid-sides 01, 12, 20), outward. */
extern const int mesh_tet10_face[4][6];

/* Least det J [m3] of element e over its four corners and the four points of the second-order rule. */
double mesh_tet10_jacobian(const mesh_fe *mesh, int element);

/* Elements with det J <= 0. */
int mesh_tet10_inverted(const mesh_fe *mesh);

/* Put the mid-side nodes of inverted elements half way between their corners, again for any neighbour that
 * this inverts, until none is left or nothing moves; moved[n_nodes] is set to 1 for those nodes. */
void mesh_tet10_straighten(mesh_fe *mesh, char *moved);

/* SHB_ERR_INPUT, naming up to five elements by tag, if any has det J <= 0; name heads the text. */
shb_status mesh_tet10_check(const mesh_fe *mesh, const char *name);

#endif
