/* Volumes of gmsh's current model, by name or by a point in them. */
#ifndef MESH_GMSH_VOLUMES_H
#define MESH_GMSH_VOLUMES_H

#include "mesh/core/fe_mesh.h"

/* mesh->region from the physical volumes that names asks for, or the volumes in which its points lie; mesh as imported from the
 * model, in its unit. SHB_ERR_INPUT: a name that is not there (those that are, are told), elements in no volume or in two. */
shb_status mesh_volumes_assign(const char *path, const mesh_names *names, mesh_fe *mesh);

#endif
