/* A second-order mesh of tetrahedra or of hexahedra in memory: nodes, elements, named sets. */
#ifndef MESH_CORE_FE_MESH_H
#define MESH_CORE_FE_MESH_H

#include <stdbool.h>
#include <stddef.h>

#include "mesh/base/axes.h"
#include "mesh/base/status.h"
#include "mesh/core/element_topology.h"

typedef enum {
  MESH_ROOT,
  MESH_CONTACT_RIGHT,
  MESH_CONTACT_LEFT,
  MESH_LOAD,
  MESH_N_SETS
} mesh_set_id;

enum {
  MESH_MAX_MORE    = 16,
  MESH_MAX_SETS    = MESH_N_SETS + MESH_MAX_MORE,
  MESH_MAX_VOLUMES = 16,
  MESH_WORD        = 81,
  MESH_FOUND       = 200 /* of a text that lists groups */
};

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
  int      *connectivity;                   /* [n_elements][nodes] node indices, gmsh order */
  long     *node_tag;                       /* [n_nodes] tag in the mesh file */
  long     *element_tag;                    /* [n_elements] tag in the mesh file */
  int       n_more;                         /* groups besides the usual four: */
  char      more[MESH_MAX_MORE][MESH_WORD]; /* their names, */
  mesh_face_set set[MESH_MAX_SETS];         /* their faces after those of the four */
  char found[MESH_FOUND]; /* "a, b": groups of the file, also those that were not asked for */
  int  n_regions;         /* volumes that were asked for, 0: none */
  char (*region_name)[MESH_WORD]; /* [n_regions] */
  int *region;                    /* [n_elements] the one each element lies in; NULL without */
} mesh_fe;

/* What is read from a mesh file, by its names there. Labels are our names, and the file's unless it has another. */
typedef struct {
  const char *set[MESH_N_SETS]; /* NULL: the usual names */
  int         n_more;           /* further groups of faces */
  struct {
    const char *label, *name;
  } more[MESH_MAX_MORE];
  int n_volumes; /* groups of elements: every element must be in one */
  struct {
    const char *label, *name;
    bool   near; /* no group of the file, but the volume in which at lies, in the file's unit */
    double at[3];
  } volume[MESH_MAX_VOLUMES];
} mesh_names;

/* "root", "contact_right", "contact_left", "load" */
const char *mesh_set_name(mesh_set_id id);

/* All groups of the mesh, 0 .. mesh_fe_sets - 1, and the name of each. */
int         mesh_fe_sets(const mesh_fe *mesh);
const char *mesh_fe_set_name(const mesh_fe *mesh, int set);

/* Place of the group of that name, -1 if there is none. */
int mesh_fe_set_named(const mesh_fe *mesh, const char *name);

/* Add to mesh->found what the file has: as many names as there is room for, then "...". */
void mesh_fe_note_group(mesh_fe *mesh, const char *name);

/* "the mesh has the groups a, b": ends the text of what is missing. */
const char *mesh_fe_found(const mesh_fe *mesh, char text[MESH_FOUND + 40]);

/* Name of a group in the file; names may be NULL. */
const char *mesh_names_set(const mesh_names *names, int set);

/* Swap contact_right and contact_left if the outward normal of contact_right has a negative tangential
 * component (right is the side whose normal has a positive one); nothing if either group is empty.
 * Errors: SHB_ERR_INPUT if both point alike. */
shb_status mesh_fe_orient(mesh_fe *mesh, mesh_axis axis);

/* The mesh as one of several contact interfaces sees it: its groups (by place, left -1: none) are contact_right and
 * contact_left. It owns nothing. */
mesh_fe mesh_fe_facing(const mesh_fe *mesh, int right, int left);

/* mesh_fe_orient for those two groups. */
shb_status mesh_fe_orient_groups(mesh_fe *mesh, mesh_axis axis, int right, int left);

/* Index of the node nearest to point. */
int mesh_fe_nearest(const mesh_fe *mesh, const double point[3]);

/* Diagonal of the box around all nodes, m. */
double mesh_fe_extent(const mesh_fe *mesh);

/* The node nearest to point. SHB_ERR_INPUT: it is further off than MESH_FE_NEAR of the body's extent, so that another point was
 * meant (or another unit); what heads the text, as "probe.tip". */
#define MESH_FE_NEAR 0.1
shb_status mesh_fe_near(const mesh_fe *mesh, const double point[3], const char *what, int *node);

void mesh_fe_free(mesh_fe *mesh); /* also on a zeroed struct */

#endif
