/* A structured second-order bar in memory, for tests: every cell a hexahedron, or cut into six tetrahedra. */
#ifndef TESTS_SUPPORT_BOX_H
#define TESTS_SUPPORT_BOX_H

#include "mesh/core/fe_mesh.h"

/* Bar [0, size] of n cells a direction; mid-side nodes are exact. Nodes form the lattice of half cells,
 * index i + (2 n[0] + 1) (j + (2 n[1] + 1) k). MESH_ROOT is the face x = 0, MESH_LOAD the face z = size[2];
 * the contact sets are empty. Tags are index + 1. Free with mesh_fe_free. SHB_ERR_IO when out of memory. */
shb_status box_mesh(const double size[3], const int n[3], mesh_fe *mesh);

/* The same of hexahedra. Nodes in the order of that lattice, without those in the middle of faces and of cells. */
shb_status box_hex(const double size[3], const int n[3], mesh_fe *mesh);

/* Add a set of the faces whose nodes all have coordinate[direction] = value (replaces an earlier set). */
shb_status box_set(mesh_fe *mesh, mesh_set_id id, int direction, double value);

/* Write any mesh as gmsh 2.2 text with its non-empty sets as physical groups; tags as in the mesh. */
shb_status box_write(const mesh_fe *mesh, const char *path);

#endif
