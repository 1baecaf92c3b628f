/* gmsh's current model copied to a mesh in memory. */
#ifndef MESH_GMSH_IMPORT_H
#define MESH_GMSH_IMPORT_H

#include "mesh/core/fe_mesh.h"

/* Copy the second-order elements, their nodes and the groups of gmsh's current model. The faces of
 * the groups are ordered outward. A gmsh session must be open. Inverted elements are not detected.
 *   name   in   heads the messages
 *   names  in   names of the physical groups; NULL: the usual six. A missing group is empty.
 *   mesh   out  free with mesh_fe_free
 * Errors: SHB_ERR_INPUT if elements are neither all ten-node tetrahedra nor all twenty-node
 * hexahedra, or a node is absent. */
shb_status mesh_import(const char *name, const mesh_names *names, mesh_fe *mesh);

#endif
