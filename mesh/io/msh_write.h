/* A mesh in memory written to a gmsh file. */
#ifndef MESH_IO_MSH_WRITE_H
#define MESH_IO_MSH_WRITE_H

#include "mesh/base/publish.h"
#include "mesh/core/fe_mesh.h"

/* Write gmsh 2.2 text, append the provenance and publish it as path. Coordinates have 17 digits,
 * tags are those of the mesh. Groups are physical surfaces, volumes physical volumes; one volume is
 * the group body.
 * Errors: SHB_ERR_IO; no file is left behind. */
shb_status mesh_msh_write(const mesh_fe *mesh, const char *path, const shb_provenance *provenance);

#endif
