/* A small sector with a disc, and the explicit ring of all its sectors. */
#ifndef TESTS_SUPPORT_SECTOR_H
#define TESTS_SUPPORT_SECTOR_H

#include "mesh/core/fe_mesh.h"

/* A sector about the x axis of the elements in use (tests/support/fem.h). The bore is group root.
 * The disc has the sides cyclic_right and cyclic_left. A narrow leaning blade carries a shroud with
 * contact_right and contact_left; its top is group load. Nothing is symmetric, so that the sign of
 * the phase counts. The sides are not paired yet.
 *   fine  in  1 or more: cells grow by this factor in every direction */
mesh_fe make_bladed_sector(int blades, int fine);

/* Elements of the disc are region 1, the others region 0: mesh->region is to be freed. */
void sector_mark_disc(mesh_fe *sector);
/* The sector with all nodes of its disc in group root, and no cyclic sides. It shares all else; its
 * set MESH_ROOT is to be freed. */
mesh_fe sector_clamp_disc(const mesh_fe *sector);

/* Nodes of sector b in the ring: ring node of node i is node[b n_nodes + i]. */
typedef struct {
  mesh_fe mesh;
  int     blades;
  int    *node;
} sector_ring;

/* The ring of a paired sector (mesh_cyclic_pair): nodes of neighbours merged. */
sector_ring make_sector_ring(const mesh_fe *sector, mesh_axis axis, int blades);
void        free_sector_ring(sector_ring *ring);

#endif
