/* Meshes of gmsh, read without gmsh: its library takes 45 MB and 0.15 s to load. */
#ifndef MESH_IO_MSH_READ_H
#define MESH_IO_MSH_READ_H

#include "mesh/core/fe_mesh.h"

/* Read a text of version 2.2 or 4.1 as mesh_import has it from gmsh, to the last bit. False, and an
 * empty mesh, where the file has anything else: other elements or sections, numbers in binary,
 * volumes by name, a fault. gmsh shall read it then, and say what is wrong.
 *   names  in   as in mesh_import
 *   mesh   out  free with mesh_fe_free */
bool mesh_msh_read(const char *path, const mesh_names *names, mesh_fe *mesh);

#endif
