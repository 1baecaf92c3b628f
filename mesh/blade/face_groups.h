/* Faces of the fused blade identified, named, and made periodic. */
#ifndef MESH_BLADE_FACE_GROUPS_H
#define MESH_BLADE_FACE_GROUPS_H

#include "mesh/base/status.h"
#include "mesh/blade/blade_parameters.h"
#include "mesh/blade/frame.h"

/* Name the physical groups root, contact_right, contact_left, load and body on gmsh's current
 * model, with a disc also cyclic_right and cyclic_left, and make these periodic. Each leg of the
 * shroud's right side becomes a periodic copy of the left one. Errors: SHB_ERR_INPUT if a face is
 * not found exactly once: the parts of the blade cut into each other. */
shb_status mesh_face_groups_set(const mesh_blade *blade, const mesh_frame *frame, int volume);

/* Make a physical group of one entity. */
shb_status mesh_face_groups_name(int dimension, int entity, const char *name);

#endif
