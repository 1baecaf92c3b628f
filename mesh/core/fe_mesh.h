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
  MESH_CYCLIC_RIGHT, /* sides of a sector with a disc */
  MESH_CYCLIC_LEFT,
  MESH_N_SETS
} mesh_set_id;

enum {
  MESH_MAX_MORE    = 16,
  MESH_MAX_SETS    = MESH_N_SETS + MESH_MAX_MORE,
  MESH_MAX_VOLUMES = 16,
  MESH_WORD        = 81,
  MESH_FOUND       = 200 /* length of a list of groups for messages */
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
  int       n_more;                         /* number of groups besides the usual six */
  char      more[MESH_MAX_MORE][MESH_WORD]; /* their names */
  mesh_face_set set[MESH_MAX_SETS];         /* the usual six, then the others */
  char          found[MESH_FOUND];          /* "a, b": all groups of the file, for messages */
  bool          unit_given;                 /* the unit of the file is known, for messages */
  int           n_regions;                  /* number of volumes with a material; 0: one material */
  char (*region_name)[MESH_WORD];           /* [n_regions] */
  int   *region; /* [n_elements] volume of each element; NULL: one material */
  int   *image; /* [n_nodes] of a node of cyclic_right its partner on cyclic_left, else -1; NULL: no
                  sector (mesh/core/cyclic_sides.h) */
  double turn[3][3]; /* of a sector: motion of such a node = turn times that of its partner */
} mesh_fe;

/* Groups and volumes to read from a mesh file. A label is the name in the case, a name that in the
 * file. */
typedef struct {
  const char *set[MESH_N_SETS]; /* NULL: the usual names */
  int         n_more;           /* further groups of faces */
  struct {
    const char *label, *name;
  } more[MESH_MAX_MORE];
  int n_volumes; /* groups of elements; every element must be in one */
  struct {
    const char *label, *name;
    bool   near; /* true: the volume in which at lies, in the unit of the file; name is not used */
    double at[3];
  } volume[MESH_MAX_VOLUMES];
} mesh_names;

/* "root", "contact_right", "contact_left", "load", "cyclic_right", "cyclic_left" */
const char *mesh_set_name(mesh_set_id id);

/* Number of groups, and the name of each. */
int         mesh_fe_sets(const mesh_fe *mesh);
const char *mesh_fe_set_name(const mesh_fe *mesh, int set);

/* Index of the group of that name, -1 if there is none. */
int mesh_fe_set_named(const mesh_fe *mesh, const char *name);

/* Append a group of the file to mesh->found: as many names as fit, then "...". */
void mesh_fe_note_group(mesh_fe *mesh, const char *name);

/* Index of the set that a group of the file is, -1: none. The group is noted if it has a name. */
int mesh_fe_take_group(mesh_fe *mesh, const mesh_names *names, const char *label);

/* "the mesh has the groups a, b", for the message about a missing group. */
const char *mesh_fe_found(const mesh_fe *mesh, char text[MESH_FOUND + 40]);

/* Name of a group in the file; names may be NULL. */
const char *mesh_names_set(const mesh_names *names, int set);

/* Swap contact_right and contact_left if the outward normal of contact_right has a negative
 * tangential component. Nothing is done if either group is empty.
 * Errors: SHB_ERR_INPUT if both normals point alike. */
shb_status mesh_fe_orient(mesh_fe *mesh, mesh_axis axis);

/* View of the mesh for one of several contact interfaces: contact_right and contact_left are the
 * groups of these indices (left -1: none). The view owns nothing. */
mesh_fe mesh_fe_facing(const mesh_fe *mesh, int right, int left);

/* mesh_fe_orient for the groups of these indices. */
shb_status mesh_fe_orient_groups(mesh_fe *mesh, mesh_axis axis, int right, int left);

/* Index of the node nearest to point. */
int mesh_fe_nearest(const mesh_fe *mesh, const double point[3]);

/* Diagonal of the box around all nodes, m. */
double mesh_fe_extent(const mesh_fe *mesh);

/* End of a message about a place, "" for a body of usual extent in m, and where the case gives the
 * unit. Otherwise it asks whether the coordinates are in mm. */
const char *mesh_unit_hint(double extent, bool unit_given);

/* Node nearest to point.
 *   what  in  heads the message, e.g. "probe.tip"
 * Errors: SHB_ERR_INPUT if its distance exceeds MESH_FE_NEAR times the extent of the body: another
 * point or unit was meant. */
#define MESH_FE_NEAR 0.1
shb_status mesh_fe_near(const mesh_fe *mesh, const double point[3], const char *what, int *node);

void mesh_fe_free(mesh_fe *mesh); /* also on a zeroed struct */

#endif
