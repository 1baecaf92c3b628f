/* Faces of named groups against the elements behind them. */
#ifndef MESH_CORE_FACES_H
#define MESH_CORE_FACES_H

#include "mesh/core/fe_mesh.h"

/* Give every face of every set its element's own nodes, ordered outward. SHB_ERR_INPUT if a face is on no
 * element, or inside the body (between two elements); name heads the text. */
shb_status mesh_faces_orient(mesh_fe *mesh, const char *name);

/* The faces on the surface of the body whose nodes are all marked ([n_nodes], NULL: every face), outward, in the
 * order of elements; set->nodes is malloc'ed. SHB_ERR_IO no memory. */
shb_status mesh_faces_outer(const mesh_fe *mesh, const char *marked, mesh_face_set *set);

#endif
