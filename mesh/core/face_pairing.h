/* Contact faces paired: where each node of the right face meets the neighbour's left one.
 *
 * Faces that match node for node (mesh_fe_match) are paired so. Else every right node is projected onto the left face
 * turned by the sector angle: at the nearest point X(r, s) of a left face, u_left = sum_j N_j(r, s) u_j, which is exact for
 * fields that the elements hold exactly, and of third order in the size of the left faces for others. */
#ifndef MESH_CORE_FACE_PAIRING_H
#define MESH_CORE_FACE_PAIRING_H

#include <stdbool.h>

#include "mesh/core/fe_mesh.h"

typedef struct {
  int     n;     /* right nodes, each once, ascending */
  int    *right; /* [n] */
  int    *start; /* [n + 1] left nodes of right[i]: start[i] .. start[i + 1] - 1 */
  int    *left;
  double *share; /* their weights, sum 1 */
  bool    projected;
  double
      gap; /* m, greatest distance between a right node and its place on the left face; 0 if they match */
} mesh_pairing;

/* How far apart projected faces may be, in square roots of the right face's area. */
#define MESH_PAIRING_GAP 0.02

/* Sets must be oriented (mesh_fe_orient). SHB_ERR_INPUT: a group is missing, or a right node is too far from the left
 * face (it and the distance are named); SHB_ERR_IO. */
shb_status mesh_pairing_create(const mesh_fe *mesh, mesh_axis axis, int blades, mesh_pairing *out);

void mesh_pairing_free(mesh_pairing *pairing); /* also on a zeroed struct */

#endif
