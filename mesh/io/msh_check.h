/* What gmsh may open as a mesh. */
#ifndef MESH_IO_MSH_CHECK_H
#define MESH_IO_MSH_CHECK_H

#include "mesh/base/status.h"

/* Is the file a whole gmsh mesh of version 2.2 or 4.1? gmsh runs a file that does not begin with
 * $MeshFormat or $Comments as a script, system commands included. So it must not open a file that
 * is refused here.
 * Errors: SHB_ERR_INPUT another kind, another version, cut short; SHB_ERR_IO unreadable. */
shb_status mesh_msh_check(const char *path);

#endif
