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

/* Write the mesh with its groups, as surfaces and as node sets, and publish it. Numbers of nodes and elements stay;
 * coordinates, in m, are read back as they were, or to 14 to 16 digits where 17 do not fit into the 20 characters that
 * CalculiX reads. The body is the element set "body", volumes are element sets, all nodes are "nodes"; nothing but the mesh is written. SHB_ERR_IO. */
shb_status mesh_inp_write(const mesh_fe *mesh, const char *path);

#endif
