#include "fem/element/quadrature.h"

#include <math.h>
#include <petscdt.h>

void fem_tet_rule_4(fem_rule *rule) {
  const double near = (5 - sqrt(5)) / 20, far = (5 + 3 * sqrt(5)) / 20;
  rule->n = 4;
  for (int p = 0; p < 4; p++) {
    double at[3] = {near, near, near};
    if (p > 0) at[p - 1] = far;
    rule->weight[p] = 1. / 24;
    mesh_shape(MESH_TET10, at, rule->shape[p], rule->gradient[p]);
  }
}

/* Quadrature with n points a direction on a reference shape in d dimensions. PETSc's shapes lie in
 * [-1, 1]^d, the simplex below the diagonal. They are mapped to [0, 1]^d.
 *   at  out  [points][d] */
static PetscErrorCode tabulate(mesh_kind kind, int d, int n, int most, int *count, double *at,
                               double *weight) {
  PetscQuadrature  quadrature;
  const PetscReal *point, *w;
  PetscInt         points;

  PetscFunctionBeginUser;
  if (kind == MESH_TET10)
    PetscCall(PetscDTStroudConicalQuadrature(d, 1, n, -1, 1, &quadrature));
  else
    PetscCall(PetscDTGaussTensorQuadrature(d, 1, n, -1, 1, &quadrature));
  PetscCall(PetscQuadratureGetData(quadrature, NULL, NULL, &points, &point, &w));
  PetscCheck(points <= most, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "a rule of %d points a direction is too large", n);
  *count = (int)points;
  for (int p = 0; p < *count; p++) {
    for (int x = 0; x < d; x++) at[d * p + x] = (point[d * p + x] + 1) / 2;
    weight[p] = w[p] / (1 << d);
  }
  PetscCall(PetscQuadratureDestroy(&quadrature));
  PetscFunctionReturn(0);
}

static PetscErrorCode volume_rule(mesh_kind kind, int n, fem_rule *rule) {
  double at[FEM_POINTS][3];
  PetscFunctionBeginUser;
  PetscCall(tabulate(kind, 3, n, FEM_POINTS, &rule->n, &at[0][0], rule->weight));
  for (int p = 0; p < rule->n; p++) mesh_shape(kind, at[p], rule->shape[p], rule->gradient[p]);
  PetscFunctionReturn(0);
}

PetscErrorCode fem_tet_rule_conical(int n, fem_rule *rule) {
  return volume_rule(MESH_TET10, n, rule);
}

PetscErrorCode fem_hex_rule(int n, fem_rule *rule) {
  return volume_rule(MESH_HEX20, n, rule);
}

PetscErrorCode fem_face_rule_create(mesh_kind kind, fem_face_rule *rule) {
  double at[FEM_FACE_POINTS][2];
  PetscFunctionBeginUser;
  rule->nodes = mesh_topology_of(kind)->face_nodes;
  PetscCall(tabulate(kind, 2, 4, FEM_FACE_POINTS, &rule->n, &at[0][0], rule->weight));
  for (int p = 0; p < rule->n; p++) mesh_face_shape(kind, at[p], rule->shape[p], rule->gradient[p]);
  PetscFunctionReturn(0);
}
