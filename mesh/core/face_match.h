/* Contact faces that match node for node. */
#ifndef MESH_CORE_FACE_MATCH_H
#define MESH_CORE_FACE_MATCH_H

#include "mesh/core/fe_mesh.h"

/* Left node on each right node after the left face is rotated by the sector angle 2 pi/blades.
 *   n_pairs      out  right nodes, each counted once
 *   right_nodes  out  [n_pairs] ascending, malloc'ed
 *   left_nodes   out  [n_pairs] malloc'ed
 * Errors: SHB_ERR_INPUT if a group is empty, the counts differ or a distance exceeds 1e-9 m; the
 * message names the distance and the node. */
shb_status mesh_fe_match(const mesh_fe *mesh, mesh_axis axis, int blades, int *n_pairs,
                         int **right_nodes, int **left_nodes);

#endif
