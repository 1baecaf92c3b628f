/* A second-order mesh of tetrahedra or of hexahedra in memory: nodes, elements, named sets. */
#ifndef MESH_FE_MESH_H
#define MESH_FE_MESH_H

#include <stddef.h>

#include "mesh/axes.h"
#include "mesh/status.h"
#include "mesh/topology.h"

typedef enum {
  MESH_ROOT,
  MESH_CONTACT_RIGHT,
  MESH_CONTACT_LEFT,
  MESH_LOAD,
  MESH_N_SETS
} mesh_set_id;

/* A named group of element faces; n = 0 if the group is absent. */
typedef struct {
  int  n;     /* faces */
  int *nodes; /* [n][face_nodes] node indices: corners, outward, then the middles of the sides */
} mesh_face_set;

typedef struct {
  mesh_kind kind; /* of all elements; the numbers of nodes are those of mesh_topology_of(kind) */
  int       n_nodes;
  double   *coordinates; /* [n_nodes][3], m */
  int       n_elements;
  int      *connectivity; /* [n_elements][nodes] node indices, gmsh order */
  long     *node_tag;     /* [n_nodes] tag in the mesh file */
  long     *element_tag;  /* [n_elements] tag in the mesh file */
  mesh_face_set set[MESH_N_SETS];
} mesh_fe;

/* "root", "contact_right", "contact_left", "load" */
const char *mesh_set_name(mesh_set_id id);

/* Read a gmsh .msh file (2.2 or 4.1) with those physical groups, or an .inp file (mesh/inp.h). Only nodes that an element
 * uses are kept.
 * Errors: SHB_ERR_IO unreadable; SHB_ERR_INPUT neither all tet10 nor all hex20, no volume elements, group root absent or empty,
 * inverted elements (det J <= 0 at a quadrature or corner point; the first five tags are named), a group's
 * face not on the surface of the body. */
shb_status mesh_fe_read(const char *path, mesh_fe *mesh);

/* The same where groups have other names in the file (group[id], NULL: the usual one; or group itself NULL) and root may
 * be absent: that is mesh_fe_check_root's to tell. */
shb_status mesh_fe_read_named(const char *path, const char *const group[MESH_N_SETS],
                              mesh_fe *mesh);
shb_status mesh_fe_check_root(const mesh_fe *mesh, const char *name);

/* Which left node lies on each right node after rotating the left face by the sector angle 2 pi/blades.
 *   match  out  [n_right_unique] pairs are returned through right_nodes/left_nodes, malloc'ed, sorted by right
 * Errors: SHB_ERR_INPUT if counts differ or a distance exceeds 1e-9 m (the distance and node are named). */
shb_status mesh_fe_match(const mesh_fe *mesh, mesh_axis axis, int blades, int *n_pairs,
                         int **right_nodes, int **left_nodes);

/* Swap contact_right and contact_left if the outward normal of contact_right has a negative tangential
 * component (right is the side whose normal has a positive one); nothing if either group is empty.
 * Errors: SHB_ERR_INPUT if both point alike. */
shb_status mesh_fe_orient(mesh_fe *mesh, mesh_axis axis);

/* Index of the node nearest to point. */
int mesh_fe_nearest(const mesh_fe *mesh, const double point[3]);

void mesh_fe_free(mesh_fe *mesh); /* also on a zeroed struct */

#endif
