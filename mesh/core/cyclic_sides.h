/* Sides of a sector: pairing of the nodes of cyclic_right with those of cyclic_left.
 *
 * The sector turned by +2 pi/N about the engine axis is the next one. Its left side lies on the
 * right side of this sector. With T the rotation by 2 pi/N, the motion at nodal diameter n is
 * u_right = e^(-j theta) T u_left, theta = 2 pi n/N (docs/theory/cyclic_sector.md). */
#ifndef MESH_CORE_CYCLIC_SIDES_H
#define MESH_CORE_CYCLIC_SIDES_H

#include "mesh/core/fe_mesh.h"

/* Largest distance between partners, in extents of the body. */
#define MESH_CYCLIC_GAP 1e-6

typedef struct {
  int    n;   /* pairs; 0: the mesh has no cyclic sides */
  double gap; /* m, largest distance between partners after the turn */
} mesh_cyclic_sides;

/* Set mesh->image and mesh->turn; nothing where both groups are absent. The groups are swapped if
 * cyclic_right is the side at -2 pi/N.
 *
 * Errors: SHB_ERR_INPUT if one group is absent, or the sides are those of another number of blades.
 * SHB_ERR_INPUT for nodes without a partner; the message gives their number and the worst distance.
 * SHB_ERR_INPUT for a node on the engine axis, or a clamped node with a free partner. */
shb_status mesh_cyclic_pair(mesh_fe *mesh, mesh_axis axis, int blades, mesh_cyclic_sides *out);

/* View of the mesh for nodal diameter N/2 (u_right = -T u_left); it owns nothing. */
mesh_fe mesh_cyclic_alternating(const mesh_fe *mesh);

#endif
