/* Groups that cannot be right together: faces that are clamped and shall move. */
#ifndef MESH_CORE_GROUP_CHECKS_H
#define MESH_CORE_GROUP_CHECKS_H

#include "mesh/core/fe_mesh.h"

/* Refuses a contact face all nodes of which are in group root, another group that lies there as a whole, and a face that is both
 * contact_right and contact_left; the groups, how many faces, and where the first is are told. Faces that meet along an edge are
 * well. name heads the text. SHB_ERR_INPUT; SHB_ERR_IO: no memory. */
shb_status mesh_overlap_check(const mesh_fe *mesh, const char *name);

#endif
