/* Mesh files of Abaqus and CalculiX (.inp). */
#ifndef MESH_IO_INP_READ_H
#define MESH_IO_INP_READ_H

#include "mesh/core/fe_mesh.h"

/* Read the mesh of an .inp file; materials, constraints and steps are ignored.
 *
 * A group (root, contact_right, ...) is the surface of its name. Without one it is the element set
 * of shells or membranes of its name. Without either it is the node set of its name: its faces are
 * those of the body with all nodes in the set. A volume is an element set. Inverted elements are
 * not detected.
 *   names  in   as in mesh_import; a missing group is empty
 *   mesh   out  free with mesh_fe_free
 * Errors as mesh_fe_read; SHB_ERR_INPUT with the line: "path:line: ...". */
shb_status mesh_inp_read(const char *path, const mesh_names *names, mesh_fe *mesh);

#endif
