/* Quadrature on the reference elements and faces of mesh/core/element_topology.h, with tabulated
 * shape functions. */
#ifndef FEM_ELEMENT_QUADRATURE_H
#define FEM_ELEMENT_QUADRATURE_H

#include <petscsys.h>

#include "mesh/core/element_topology.h"

enum { FEM_POINTS = 64, FEM_FACE_POINTS = 16 };

typedef struct {
  int    n;                                   /* points */
  double weight[FEM_POINTS];                  /* sum: volume of the reference element, 1/6 or 1 */
  double shape[FEM_POINTS][MESH_NODES];       /* N_i */
  double gradient[FEM_POINTS][MESH_NODES][3]; /* dN_i / d(r, s, t) */
} fem_rule;

typedef struct {
  int    nodes;                                         /* of the face */
  int    n;                                             /* points */
  double weight[FEM_FACE_POINTS];                       /* sum 1/2 or 1 */
  double shape[FEM_FACE_POINTS][MESH_FACE_NODES];       /* N_i */
  double gradient[FEM_FACE_POINTS][MESH_FACE_NODES][2]; /* dN_i / d(r, s) */
} fem_face_rule;

/* Four symmetric points, exact to degree 2; CalculiX's C3D10. */
void fem_tet_rule_4(fem_rule *rule);

/* Conical product of n Gauss points a direction, exact to degree 2n - 1; n = 1 .. 4. PETSc must be
 * initialised. */
PetscErrorCode fem_tet_rule_conical(int n, fem_rule *rule);

/* Product of n Gauss points a direction, exact to degree 2n - 1 in each; n = 1 .. 4. PETSc must be
 * initialised. */
PetscErrorCode fem_hex_rule(int n, fem_rule *rule);

/* 16 points on a face of the element, exact to degree 7 (in each direction of a quadrangle). */
PetscErrorCode fem_face_rule_create(mesh_kind kind, fem_face_rule *rule);

#endif
