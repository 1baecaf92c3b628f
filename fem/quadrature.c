#include "fem/quadrature.h"

#include <math.h>
#include <petscdt.h>
#include <string.h>

/* Corners a, b of each mid-side node. */
static const int tet_edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};
static const int tri_edge[3][2] = {{0, 1}, {1, 2}, {2, 0}};

/* Barycentric form in any dimension d: corners L(2L - 1), mid-sides 4 La Lb, and dL/dx constant. */
static void shape_of(int d, const int (*edge)[2], const double *at, double *shape,
                     double *gradient) {
  double barycentric[4] = {1}, slope[4][3] = {{0}};
  for (int x = 0; x < d; x++) {
    barycentric[0] -= at[x];
    barycentric[x + 1] = at[x];
    slope[0][x]        = -1;
    slope[x + 1][x]    = 1;
  }
  for (int c = 0; c <= d; c++) {
    double L = barycentric[c];
    shape[c] = L * (2 * L - 1);
    for (int x = 0; x < d; x++) gradient[c * d + x] = (4 * L - 1) * slope[c][x];
  }
  for (int e = 0; e < d * (d + 1) / 2; e++) {
    int a = edge[e][0], b = edge[e][1], node = d + 1 + e;
    shape[node] = 4 * barycentric[a] * barycentric[b];
    for (int x = 0; x < d; x++)
      gradient[node * d + x] = 4 * (barycentric[a] * slope[b][x] + barycentric[b] * slope[a][x]);
  }
}

void fem_tet10_shape(const double at[3], double shape[10], double gradient[10][3]) {
  shape_of(3, tet_edge, at, shape, &gradient[0][0]);
}

void fem_tri6_shape(const double at[2], double shape[6], double gradient[6][2]) {
  shape_of(2, tri_edge, at, shape, &gradient[0][0]);
}

void fem_tet_rule_4(fem_tet_rule *rule) {
  const double near = (5 - sqrt(5)) / 20, far = (5 + 3 * sqrt(5)) / 20;
  rule->n = 4;
  for (int p = 0; p < 4; p++) {
    double at[3] = {near, near, near};
    if (p > 0) at[p - 1] = far;
    rule->weight[p] = 1. / 24;
    fem_tet10_shape(at, rule->shape[p], rule->gradient[p]);
  }
}

/* PETSc's reference simplex is [-1, 1]^d below the diagonal: halve it onto [0, 1]^d. */
PetscErrorCode fem_tet_rule_conical(int n, fem_tet_rule *rule) {
  PetscQuadrature  quadrature;
  const PetscReal *point, *weight;
  PetscInt         count;

  PetscFunctionBeginUser;
  PetscCall(PetscDTStroudConicalQuadrature(3, 1, n, -1, 1, &quadrature));
  PetscCall(PetscQuadratureGetData(quadrature, NULL, NULL, &count, &point, &weight));
  PetscCheck(count <= FEM_TET_POINTS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "a conical rule of %d points a direction is too large", n);
  rule->n = (int)count;
  for (int p = 0; p < rule->n; p++) {
    double at[3];
    for (int x = 0; x < 3; x++) at[x] = (point[3 * p + x] + 1) / 2;
    rule->weight[p] = weight[p] / 8;
    fem_tet10_shape(at, rule->shape[p], rule->gradient[p]);
  }
  PetscCall(PetscQuadratureDestroy(&quadrature));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_tri_rule_conical(int n, fem_tri_rule *rule) {
  PetscQuadrature  quadrature;
  const PetscReal *point, *weight;
  PetscInt         count;

  PetscFunctionBeginUser;
  PetscCall(PetscDTStroudConicalQuadrature(2, 1, n, -1, 1, &quadrature));
  PetscCall(PetscQuadratureGetData(quadrature, NULL, NULL, &count, &point, &weight));
  PetscCheck(count <= FEM_TRI_POINTS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "a conical rule of %d points a direction is too large", n);
  rule->n = (int)count;
  for (int p = 0; p < rule->n; p++) {
    double at[2];
    for (int x = 0; x < 2; x++) at[x] = (point[2 * p + x] + 1) / 2;
    rule->weight[p] = weight[p] / 4;
    fem_tri6_shape(at, rule->shape[p], rule->gradient[p]);
  }
  PetscCall(PetscQuadratureDestroy(&quadrature));
  PetscFunctionReturn(0);
}
