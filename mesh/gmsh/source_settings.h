/* Where the mesh of a blade comes from when it is not the parametric one. */
#ifndef MESH_GMSH_SOURCE_SETTINGS_H
#define MESH_GMSH_SOURCE_SETTINGS_H

#include "mesh/core/group_rules.h"

typedef struct {
  const char *path;
  double      unit; /* m: length of one unit of the file's coordinates; STEP files arrive in mm */
  double      size; /* m, element size of a solid; 0: as the file says (.geo) */
  mesh_axis   axis;
  int blades; /* contact faces of a solid are made to match after this sector; 0: contact to ground */
  mesh_rules rules;
  int        n_contacts; /* several contact interfaces, 0: contact_right and contact_left */
  struct {
    char right[MESH_WORD], left[MESH_WORD];
  } contact[MESH_MAX_MORE / 2];
} mesh_source;

#endif
