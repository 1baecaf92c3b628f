/* Pairing of contact faces: the point of the left face that each right node meets.
 *
 * Faces that match node for node (mesh_fe_match) are paired by nodes. Otherwise each right node is
 * projected to the nearest point X(r, s) of the left face rotated by the sector angle. The
 * displacement there is u_left = sum_j N_j(r, s) u_j. It is exact for fields that the elements
 * represent, and of third order in the size of the left faces for others. */
#ifndef MESH_CORE_FACE_PAIRING_H
#define MESH_CORE_FACE_PAIRING_H

#include <stdbool.h>

#include "mesh/core/fe_mesh.h"

typedef struct {
  int     n;     /* right nodes, each once, ascending */
  int    *right; /* [n] */
  int    *start; /* [n + 1] left nodes of right[i]: start[i] .. start[i + 1] - 1 */
  int    *left;
  double *share; /* weights N_j of the left nodes, sum 1 */
  bool    projected;
  double  gap; /* m, largest distance of a right node from its point on the left face */
} mesh_pairing;

/* Largest distance of projected faces, in square roots of the right face's area. */
#define MESH_PAIRING_GAP 0.02

/* Pair the contact faces; the sets must be oriented (mesh_fe_orient).
 * Errors: SHB_ERR_INPUT if a group is missing. SHB_ERR_INPUT if a right node is too far from the
 * left face; the message names node and distance. */
shb_status mesh_pairing_create(const mesh_fe *mesh, mesh_axis axis, int blades, mesh_pairing *out);

void mesh_pairing_free(mesh_pairing *pairing); /* also on a zeroed struct */

#endif
