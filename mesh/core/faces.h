/* Faces of named groups, located on the elements. */
#ifndef MESH_CORE_FACES_H
#define MESH_CORE_FACES_H

#include "mesh/core/fe_mesh.h"

/* Replace the nodes of every face of every set by those of its element, ordered outward.
 *   name  in  heads the message
 * Errors: SHB_ERR_INPUT if a face is on no element, or between two elements. */
shb_status mesh_faces_orient(mesh_fe *mesh, const char *name);

/* Faces on the surface of the body all nodes of which are marked, ordered outward, by element.
 *   marked  in   [n_nodes]; NULL: every face
 *   set     out  nodes malloc'ed */
void mesh_faces_outer(const mesh_fe *mesh, const char *marked, mesh_face_set *set);

#endif
