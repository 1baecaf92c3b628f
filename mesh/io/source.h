/* Mesh of a blade that is not parametric: read from a mesh file, or made from a solid. */
#ifndef MESH_IO_SOURCE_H
#define MESH_IO_SOURCE_H

#include "mesh/base/progress.h"
#include "mesh/gmsh/source_settings.h"

/* Read the mesh or mesh the solid, and select the faces of every group; coordinates in m.
 * Errors: SHB_ERR_INPUT, SHB_ERR_IO, SHB_INTERRUPTED. */
shb_status mesh_source_read(const mesh_source *source, shb_progress *progress, mesh_fe *mesh);

#endif
