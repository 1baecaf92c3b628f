/* A structured second-order bar in memory: hexahedra, or each cell cut into six tetrahedra. */
#ifndef TESTS_SUPPORT_BOX_H
#define TESTS_SUPPORT_BOX_H

#include "mesh/core/fe_mesh.h"

/* Bar [0, size] with n cells per direction; mid-side nodes are exact. Nodes form the lattice of
 * half cells, index i + (2 n[0] + 1) (j + (2 n[1] + 1) k). MESH_ROOT is the face x = 0 and
 * MESH_LOAD the face z = size[2]. The contact sets are empty. Tags are index + 1. Free with
 * mesh_fe_free. Errors: SHB_ERR_IO no memory. */
shb_status box_mesh(const double size[3], const int n[3], mesh_fe *mesh);

/* The same with hexahedra. Its nodes follow the same lattice, without the middles of faces and
 * cells. */
shb_status box_hex(const double size[3], const int n[3], mesh_fe *mesh);

/* Add a set of the faces whose nodes all have coordinate[direction] = value. It replaces an older
 * set. */
shb_status box_set(mesh_fe *mesh, mesh_set_id id, int direction, double value);

/* Write a mesh as gmsh 2.2 text with its non-empty sets as physical groups. Tags are those of the
 * mesh. */
shb_status box_write(const mesh_fe *mesh, const char *path);

#endif
