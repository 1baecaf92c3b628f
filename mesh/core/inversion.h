/* Why an element has det J <= 0. */
#ifndef MESH_CORE_INVERSION_H
#define MESH_CORE_INVERSION_H

#include "mesh/core/fe_mesh.h"

typedef enum {
  MESH_REPEATED,     /* a node occurs twice, or two nodes are at one place */
  MESH_FLAT,         /* the corners lie in one plane */
  MESH_MIRRORED,     /* the corners go round the other way */
  MESH_FOLDED,       /* of a hexahedron: some of the corners do */
  MESH_MIDDLE_ORDER, /* middle nodes lie on other edges of the element than theirs */
  MESH_CURVED,       /* with straight edges the element would be sound */
  MESH_N_INVERSIONS
} mesh_inversion;

enum { MESH_INVERSION_TEXT = 256 };

mesh_inversion mesh_inversion_of(const mesh_fe *mesh, int element);

/* What is wrong with an element and what would be right, with tags of its nodes. Returns text. */
const char *mesh_inversion_describe(const mesh_fe *mesh, int element,
                                    char text[MESH_INVERSION_TEXT]);

#endif
