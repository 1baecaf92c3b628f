/* A mesh in memory to a published gmsh file. */
#ifndef MESH_IO_MSH_WRITE_H
#define MESH_IO_MSH_WRITE_H

#include "mesh/base/publish.h"
#include "mesh/core/fe_mesh.h"

/* Write gmsh 2.2 text: nodes to the last bit, elements, the groups as physical surfaces, the volumes, or the one volume as group body; the
 * provenance after it. Tags as in the mesh. SHB_ERR_IO; nothing is left behind then. */
shb_status mesh_msh_write(const mesh_fe *mesh, const char *path, const shb_provenance *provenance);

#endif
