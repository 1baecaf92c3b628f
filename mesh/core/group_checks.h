/* Checks of groups: those that must have faces, and those that exclude each other. */
#ifndef MESH_CORE_GROUP_CHECKS_H
#define MESH_CORE_GROUP_CHECKS_H

#include "mesh/core/fe_mesh.h"

/* Check that group root and the groups besides the usual six have faces, and that no groups
 * overlap.
 *
 * A contact face must not have all its nodes in group root. Another group must not lie in root as a
 * whole. A face must not be both contact_right and contact_left, nor a face of contact or load one
 * of a cyclic side. Faces that meet along an edge are allowed. The message names the groups, the
 * number of faces and the place of the first.
 *   name  in  heads the message
 * Errors: SHB_ERR_INPUT. */
shb_status mesh_fe_check_groups(const mesh_fe *mesh, const char *name);

#endif
