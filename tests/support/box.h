/* A structured second-order bar in memory: every cell a hexahedron, or six tetrahedra. */
#ifndef TESTS_SUPPORT_BOX_H
#define TESTS_SUPPORT_BOX_H

#include "mesh/core/fe_mesh.h"

/* Bar [0, size] with n cells a direction, of tetrahedra; mid-side nodes are exact. Nodes form the
 * lattice of half cells with index i + (2 n[0] + 1) (j + (2 n[1] + 1) k). MESH_ROOT is the face x =
 * 0, MESH_LOAD the face z = size[2]; the contact sets are empty. Tags are index + 1. Free with
 * mesh_fe_free. SHB_ERR_IO when out of memory. */
shb_status box_mesh(const double size[3], const int n[3], mesh_fe *mesh);

/* The bar of hexahedra. Nodes are in the order of that lattice, without those in the middle of
 * faces and cells. */
shb_status box_hex(const double size[3], const int n[3], mesh_fe *mesh);

/* Set a group to the faces all nodes of which have coordinate[direction] = value. */
shb_status box_set(mesh_fe *mesh, mesh_set_id id, int direction, double value);

/* Write a mesh as gmsh 2.2 text with its non-empty sets as physical groups; tags as in the mesh. */
shb_status box_write(const mesh_fe *mesh, const char *path);

#endif
