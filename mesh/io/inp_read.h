/* Meshes of Abaqus and CalculiX (.inp). */
#ifndef MESH_IO_INP_READ_H
#define MESH_IO_INP_READ_H

#include "mesh/core/fe_mesh.h"

/* Read an .inp file. A group (root, contact_right, ...) is, in this order: the surface of that name, the shells or
 * membranes of the element set of that name, or the faces of the body all of whose nodes are in the node set of that
 * name; a volume is the element set of that name. names: as mesh_import; a group that is not there is empty. Only the mesh is taken: materials,
 * constraints and steps are not.
 * Errors as mesh_fe_read, SHB_ERR_INPUT with the line: "path:line: ...". Not checked: inverted elements. */
shb_status mesh_inp_read(const char *path, const mesh_names *names, mesh_fe *mesh);

#endif
