/* From gmsh's current model to a mesh in memory. */
#ifndef MESH_GMSH_IMPORT_H
#define MESH_GMSH_IMPORT_H

#include "mesh/core/fe_mesh.h"

/* Copy the second-order tetrahedra or hexahedra, their nodes and the four groups out of gmsh's current model, groups
 * oriented outward; name heads error texts. names: of the physical groups, NULL: the usual
 * four; a group that is not there is empty. A gmsh session must be open. Not checked: inverted elements.
 * Errors: SHB_ERR_INPUT other elements than ten-node tetrahedra or twenty-node
 * hexahedra, both kinds, broken references. */
shb_status mesh_import(const char *name, const mesh_names *names, mesh_fe *mesh);

#endif
