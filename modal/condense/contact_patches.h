/* Contact patches: the nodes of each contact point, their weights and axes.
 *
 * A patch moves as the mean displacement of its face, the integral of u dA divided by the area.
 * The shape functions of the faces turn it into sum_e weight[e] u(node[e]). On flat straight-sided
 * six-node triangles only mid-side nodes carry weight. Corners of eight-node quadrangles carry a
 * negative one.
 *
 * The paper's eq. 2 defines psi and phi by v = (cos psi cos phi, sin psi cos phi, -sin phi).
 *
 * Left patches are the images of the right ones one sector back, node by node. Faces that do not
 * match are projected (mesh/core/face_pairing.h); left nodes then have weights of their own. */
#ifndef MODAL_CONDENSE_CONTACT_PATCHES_H
#define MODAL_CONDENSE_CONTACT_PATCHES_H

#include <stdbool.h>

#include "mesh/core/fe_mesh.h"
#include "modal/condense/dofs.h"

enum { MODAL_MAX_INTERFACES = 8 };

typedef struct {
  int     n_pairs;
  int    *interface;   /* [n_pairs] interface of each pair after _join; else NULL */
  bool    has_left;    /* contact to the neighbour */
  int    *start;       /* [n_pairs + 1] entries of patch p: start[p] .. start[p + 1] - 1 */
  int    *node[2];     /* [entry] mesh node, right and left (NULL without left) */
  double *weight;      /* [entry], sum 1 over a patch */
  double *left_weight; /* [entry] the same of the left nodes (NULL without left) */
  bool    projected;   /* left nodes have own weights, right ones are repeated with weight 0 */
  double  gap;         /* m, largest distance between the projected faces */
  double *area;        /* [n_pairs] m2; they add up to the face's */
  double *normal;      /* [n_pairs][3] mean outward normal of the right patch, unit, in its axes */
  double *centroid[2]; /* [n_pairs][3] m, mesh axes (left NULL without left) */
  double (*axes[2])[3][3]; /* [n_pairs] rows tangential, axial, radial at the centroid */
  double total_area;       /* m2 */
  double psi, phi;         /* rad, of the face's mean normal at its centroid */
} modal_patches;

/* Divide the contact face into patches. The mesh's sets must be oriented (mesh_fe_orient).
 *
 *   points  0: one patch for each node that carries weight; 1: the whole face; n: n patches of
 *           about equal area
 *
 * Errors: SHB_ERR_INPUT group contact_right or, to the neighbour, contact_left is missing, faces do
 * not match, more patches than facets. SHB_ERR_INPUT too if a facet is turned by more than 5
 * degrees against its patch. */
shb_status modal_patches_create(const mesh_fe *mesh, mesh_axis axis, int blades, bool to_ground,
                                int points, modal_patches *out);

/* Join the patches of n interfaces, all to ground or all to the neighbour. psi and phi are those of
 * the first interface; gap is the largest. */
void modal_patches_join(int n, const modal_patches *part, modal_patches *out);

/* SHB_ERR_INPUT unless the given angles (NULL: not given) agree with the face within a degree. */
shb_status modal_patches_check_angles(const modal_patches *patches, const double *psi,
                                      const double *phi);

/* Append the contact dofs, (side * n_pairs + pair) * 3 + axis. */
void modal_patches_dofs(const modal_patches *patches, modal_dofs *dofs);

void modal_patches_free(modal_patches *patches); /* also on a zeroed struct */

#endif
