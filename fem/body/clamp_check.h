/* Is every part of the body held by the clamp? */
#ifndef FEM_BODY_CLAMP_CHECK_H
#define FEM_BODY_CLAMP_CHECK_H

#include "mesh/core/fe_mesh.h"

/* SHB_ERR_INPUT if a part of the mesh shares no node, directly or through others, with the faces of group root:
 * it would float, and K be singular. The text names one of its elements and how many there are. */
shb_status fem_clamp_check(const mesh_fe *mesh);

#endif
