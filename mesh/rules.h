/* Groups by rule: which faces on the surface of the body are root, contact_right, contact_left, load. */
#ifndef MESH_RULES_H
#define MESH_RULES_H

#include "mesh/fe_mesh.h"

typedef enum {
  MESH_RULE_NONE,    /* as the mesh file says */
  MESH_RULE_NAME,    /* the file's group of another name */
  MESH_RULE_PLANE,   /* faces in the plane through at, normal to normal */
  MESH_RULE_RADIUS,  /* faces at the distance radius from the engine axis */
  MESH_RULE_NEAREST, /* the face nearest to at, with all that goes on from it without an edge */
} mesh_rule_kind;

enum { MESH_RULE_WORD = 81 };

typedef struct {
  mesh_rule_kind kind;
  char           name[MESH_RULE_WORD];
  double         at[3];     /* m, mesh axes */
  double         normal[3]; /* of any length, mesh axes */
  double         radius;    /* m */
  double         tolerance; /* m: how far a node may be off a plane or a radius */
} mesh_rule;

/* An edge between two faces whose normals differ by more than this ends a face (MESH_RULE_NEAREST), rad. */
#define MESH_RULE_EDGE 0.35

/* Names of the groups in the file, NULL where it is the usual one; for mesh_fe_read_named. */
void mesh_rules_names(const mesh_rule rule[MESH_N_SETS], const char *name[MESH_N_SETS]);

/* Make the groups that have a rule of their own, instead of those the file had; faces outward. file heads error texts.
 * SHB_ERR_INPUT: a rule that no face fits (the nearest is named), or that has no normal; SHB_ERR_IO. */
shb_status mesh_rules_apply(const mesh_rule rule[MESH_N_SETS], mesh_axis axis, const char *file,
                            mesh_fe *mesh);

#endif
