/* Where a blade's mesh comes from when it is not the parametric one: a mesh, or a solid that is meshed here. */
#ifndef MESH_IO_SOURCE_H
#define MESH_IO_SOURCE_H

#include "mesh/base/progress.h"
#include "mesh/gmsh/source_settings.h"

/* Read, or mesh, and give every group its faces; coordinates in m. SHB_ERR_INPUT, SHB_ERR_IO, SHB_INTERRUPTED. */
shb_status mesh_source_read(const mesh_source *source, shb_progress *progress, mesh_fe *mesh);

#endif
