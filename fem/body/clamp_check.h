/* Check that the clamp holds every part of the body. */
#ifndef FEM_BODY_CLAMP_CHECK_H
#define FEM_BODY_CLAMP_CHECK_H

#include "mesh/core/fe_mesh.h"

/* SHB_ERR_INPUT if a part of the mesh is not connected by nodes to the faces of group root. It
 * would float and K would be singular. The message gives the number of such elements and one
 * tag.
 *   bodies  out  parts that share no node */
shb_status fem_clamp_check(const mesh_fe *mesh, int *bodies);

#endif
