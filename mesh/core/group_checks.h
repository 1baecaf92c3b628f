/* Groups that a computation cannot do without, and groups that exclude each other. */
#ifndef MESH_CORE_GROUP_CHECKS_H
#define MESH_CORE_GROUP_CHECKS_H

#include "mesh/core/fe_mesh.h"

/* Groups root and the further ones must have faces.
 *
 * Refused besides: a contact face all nodes of which are in group root; another group that lies in
 * root as a whole; a face that is both contact_right and contact_left. The text names the groups,
 * the number of faces and the place of the first. Faces that meet along an edge are allowed.
 *   name  in  heads the text
 * Errors: SHB_ERR_INPUT; SHB_ERR_IO no memory. */
shb_status mesh_fe_check_groups(const mesh_fe *mesh, const char *name);

#endif
