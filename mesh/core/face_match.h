/* Contact faces that match node for node. */
#ifndef MESH_CORE_FACE_MATCH_H
#define MESH_CORE_FACE_MATCH_H

#include "mesh/core/fe_mesh.h"

/* Which left node lies on each right node after rotating the left face by the sector angle 2 pi/blades.
 *   match  out  [n_right_unique] pairs are returned through right_nodes/left_nodes, malloc'ed, sorted by right
 * Errors: SHB_ERR_INPUT if counts differ or a distance exceeds 1e-9 m (the distance and node are named). */
shb_status mesh_fe_match(const mesh_fe *mesh, mesh_axis axis, int blades, int *n_pairs,
                         int **right_nodes, int **left_nodes);

#endif
