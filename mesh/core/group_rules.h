/* Groups by rule: faces on the surface of the body selected by plane, radius or nearest point. */
#ifndef MESH_CORE_GROUP_RULES_H
#define MESH_CORE_GROUP_RULES_H

#include "mesh/core/fe_mesh.h"

typedef enum {
  MESH_RULE_NONE,    /* as the mesh file defines it */
  MESH_RULE_NAME,    /* the group of another name in the file */
  MESH_RULE_PLANE,   /* faces in the plane through at, normal to normal */
  MESH_RULE_RADIUS,  /* faces at the distance radius from the engine axis */
  MESH_RULE_NEAREST, /* the face nearest to at, and all faces joined to it without an edge */
} mesh_rule_kind;

typedef struct {
  mesh_rule_kind kind;
  char           name[MESH_WORD];
  double         at[3];     /* m, mesh axes */
  double         normal[3]; /* of any length, mesh axes */
  double         radius;    /* m */
  double         tolerance; /* m: largest distance of a node from the plane or radius */
} mesh_rule;

/* Rule of a group besides the usual six, or of a volume (NONE, NAME and NEAREST only). */
typedef struct {
  char      name[MESH_WORD];
  mesh_rule rule;
} mesh_named_rule;

/* All groups of a mesh. */
typedef struct {
  mesh_rule       usual[MESH_N_SETS];
  int             n_more, n_volumes;
  mesh_named_rule more[MESH_MAX_MORE], volume[MESH_MAX_VOLUMES];
} mesh_rules;

/* Angle between the normals of two faces above which an edge separates them (MESH_RULE_NEAREST),
 * rad. */
#define MESH_RULE_EDGE 0.35

/* Largest tolerance, and largest distance of a point from its face, in extents of the body. */
#define MESH_RULE_MAX_TOLERANCE 0.01
#define MESH_RULE_MAX_DISTANCE 0.5

/* Names of the groups and volumes in the file. The strings belong to rules.
 *   unit  in  m, length of one unit of the file's coordinates */
mesh_names mesh_rules_names(const mesh_rules *rules, double unit);

/* Names in a mesh that was made by these rules: the labels. */
mesh_names mesh_rules_labels(const mesh_rules *rules);

/* Replace the groups that have a plane, radius or nearest-point rule; faces are ordered outward.
 *   file  in  heads the message
 * Errors: SHB_ERR_INPUT if no face fits a rule; the message names the nearest. SHB_ERR_INPUT if a
 * normal has no direction, a tolerance is too wide or a point too far off the body. */
shb_status mesh_rules_apply(const mesh_rules *rules, mesh_axis axis, const char *file,
                            mesh_fe *mesh);

#endif
