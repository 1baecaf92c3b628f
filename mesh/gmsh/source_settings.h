/* Settings of a blade's mesh that is read, or made from a solid. */
#ifndef MESH_GMSH_SOURCE_SETTINGS_H
#define MESH_GMSH_SOURCE_SETTINGS_H

#include "mesh/core/group_rules.h"

enum { MESH_FINEST = 20 }; /* curvature refines to this part of the size at most */

typedef struct {
  const char *path;
  double      unit;       /* m: length of one unit of the file; STEP files are read in mm */
  bool        unit_given; /* by the case or by a STEP file; else it is m by default */
  double      size;       /* m, element size of a solid; 0: as in the file (.geo) */
  double      curvature;  /* elements that a full turn of a curved face would have; 0: no matter */
  mesh_axis   axis;
  int         blades; /* periodic contact faces of a solid; 0: contact to ground */
  mesh_rules  rules;
  int         n_contacts; /* number of contact interfaces */
  struct {
    char right[MESH_WORD], left[MESH_WORD]; /* groups of its faces */
  } contact[MESH_MAX_MORE / 2];
} mesh_source;

#endif
