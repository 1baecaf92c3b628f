/* Quadrature on the reference triangle and tetrahedron, with the second-order shape functions tabulated.
 *
 * Reference coordinates run along the edges from corner 0; the shape functions are those of gmsh's 6-node
 * triangle (mid-sides of 01, 12, 20) and 10-node tetrahedron (mid-sides of 01, 12, 20, 30, 23, 13). */
#ifndef FEM_QUADRATURE_H
#define FEM_QUADRATURE_H

#include <petscsys.h>

enum { FEM_TET_POINTS = 64, FEM_TRI_POINTS = 16 };

typedef struct {
  int    n;                               /* points */
  double weight[FEM_TET_POINTS];          /* sum 1/6 */
  double shape[FEM_TET_POINTS][10];       /* N_i */
  double gradient[FEM_TET_POINTS][10][3]; /* dN_i / d(r, s, t) */
} fem_tet_rule;

typedef struct {
  int    n;                              /* points */
  double weight[FEM_TRI_POINTS];         /* sum 1/2 */
  double shape[FEM_TRI_POINTS][6];       /* N_i */
  double gradient[FEM_TRI_POINTS][6][2]; /* dN_i / d(r, s) */
} fem_tri_rule;

/* N_i and dN_i at one reference point. */
void fem_tet10_shape(const double at[3], double shape[10], double gradient[10][3]);
void fem_tri6_shape(const double at[2], double shape[6], double gradient[6][2]);

/* Four symmetric points, exact to degree 2: the stiffness of straight-sided elements, and CalculiX's C3D10. */
void fem_tet_rule_4(fem_tet_rule *rule);

/* Conical product of n Gauss points a direction, exact to degree 2n - 1; n = 1..4. Needs PETSc initialised. */
PetscErrorCode fem_tet_rule_conical(int n, fem_tet_rule *rule);
PetscErrorCode fem_tri_rule_conical(int n, fem_tri_rule *rule);

#endif
