/* Volumes of gmsh's current model, by name or by a point inside. */
#ifndef MESH_GMSH_VOLUMES_H
#define MESH_GMSH_VOLUMES_H

#include "mesh/core/fe_mesh.h"

/* Set mesh->region from the physical volumes of names, or the volumes that contain its points.
 *   mesh  in/out  as imported from the model, in its unit
 * Errors: SHB_ERR_INPUT if a name is absent (the message lists those present), or elements lie in
 * no volume or in two. */
shb_status mesh_volumes_assign(const char *path, const mesh_names *names, mesh_fe *mesh);

#endif
