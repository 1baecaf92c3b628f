/* gmsh's current model written to a .msh file. */
#ifndef MESH_GMSH_EXPORT_H
#define MESH_GMSH_EXPORT_H

#include "mesh/base/publish.h"
#include "mesh/base/status.h"

/* Write the current model (gmsh 4.1 text), append the provenance and publish the file as path. gmsh
 * orders the $Periodic section by memory address. It is left out, so that equal meshes give equal
 * files.
 * Errors: SHB_ERR_IO; no file is left behind. */
shb_status mesh_export(const char *path, const shb_provenance *provenance);

#endif
