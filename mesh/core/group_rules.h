/* Groups by rule: which faces on the surface of the body are root, contact_right, contact_left, load. */
#ifndef MESH_CORE_GROUP_RULES_H
#define MESH_CORE_GROUP_RULES_H

#include "mesh/core/fe_mesh.h"

typedef enum {
  MESH_RULE_NONE,    /* as the mesh file says */
  MESH_RULE_NAME,    /* the file's group of another name */
  MESH_RULE_PLANE,   /* faces in the plane through at, normal to normal */
  MESH_RULE_RADIUS,  /* faces at the distance radius from the engine axis */
  MESH_RULE_NEAREST, /* the face nearest to at, with all that goes on from it without an edge */
} mesh_rule_kind;

typedef struct {
  mesh_rule_kind kind;
  char           name[MESH_WORD];
  double         at[3];     /* m, mesh axes */
  double         normal[3]; /* of any length, mesh axes */
  double         radius;    /* m */
  double         tolerance; /* m: how far a node may be off a plane or a radius */
} mesh_rule;

/* The rule of a group besides the usual four, or of a volume (NONE, NAME and NEAREST only). */
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

/* An edge between two faces whose normals differ by more than this ends a face (MESH_RULE_NEAREST), rad. */
#define MESH_RULE_EDGE 0.35

/* The most a tolerance may be, and a point off the face that it names, in diagonals of the body's box. */
#define MESH_RULE_MAX_TOLERANCE 0.01
#define MESH_RULE_MAX_DISTANCE 0.5

/* Names of the groups and volumes in the file, whose coordinates count unit m; they stay the rules'. */
mesh_names mesh_rules_names(const mesh_rules *rules, double unit);

/* The same in a mesh that was made by the rules: by our own names. */
mesh_names mesh_rules_labels(const mesh_rules *rules);

/* Make the groups that have a rule of their own, instead of those the file had; faces outward. file heads error texts.
 * SHB_ERR_INPUT: a rule that no face fits (the nearest is named), that has no normal, a tolerance as wide as parts of the
 * body, or a point far off it; SHB_ERR_IO. */
shb_status mesh_rules_apply(const mesh_rules *rules, mesh_axis axis, const char *file,
                            mesh_fe *mesh);

#endif
