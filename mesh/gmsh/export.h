/* gmsh's current model to a published .msh file. */
#ifndef MESH_GMSH_EXPORT_H
#define MESH_GMSH_EXPORT_H

#include "mesh/base/publish.h"
#include "mesh/base/status.h"

/* Write the current model (gmsh 4.1 text) with the provenance after it, and publish it as path. The
 * $Periodic section, which gmsh orders by memory address, is left out: equal meshes are equal files.
 * SHB_ERR_IO; nothing is left behind then. */
shb_status mesh_export(const char *path, const shb_provenance *provenance);

#endif
