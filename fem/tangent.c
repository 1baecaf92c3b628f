#include "fem/tangent.h"

#include <string.h>

#include "fem/finite.h"

void fem_body_element(const fem_body *body, int element, const double *u, double x[10][3],
                      double v[10][3]) {
  const int *nodes = body->mesh->connectivity + 10 * (size_t)element;
  for (int i = 0; i < 10; i++) {
    size_t node = 3 * (size_t)nodes[i];
    memcpy(x[i], body->mesh->coordinates + node, sizeof x[i]);
    if (u)
      memcpy(v[i], u + node, sizeof v[i]);
    else
      memset(v[i], 0, sizeof v[i]);
  }
}

PetscErrorCode fem_residual_assemble(const fem_body *body, const fem_system *system,
                                     const double *u, Vec R) {
  PetscScalar *out;

  PetscFunctionBeginUser;
  PetscCall(VecZeroEntries(R));
  PetscCall(VecGetArray(R, &out));
  for (int e = 0; e < body->mesh->n_elements; e++) {
    PetscInt rows[10], columns[10];
    double   x[10][3], v[10][3], m[10][10], internal[10][3], load[10][3];
    if (!fem_system_rows(body->mesh, system, e, rows, columns)) continue;
    fem_body_element(body, e, u, x, v);
    const double(*at)[3] = (const double(*)[3])x, (*by)[3] = (const double(*)[3])v;
    fem_tet10_force(body->element, body->material, at, by, internal);
    fem_tet10_mass(body->element, body->material->rho, at, m);
    fem_tet10_centrifugal(&body->rotation, (const double(*)[10])m, at, by, load);
    for (int i = 0; i < 10; i++)
      for (int d = 0; d < 3 && rows[i] >= 0; d++)
        out[3 * (rows[i] - system->first) + d] += internal[i][d] - load[i][d];
  }
  PetscCall(VecRestoreArray(R, &out));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_tangent_assemble(const fem_body *body, const double *u, fem_system *system) {
  PetscFunctionBeginUser;
  PetscCall(MatZeroEntries(system->K));
  for (int e = 0; e < body->mesh->n_elements; e++) {
    PetscInt rows[10], columns[10];
    double   x[10][3], v[10][3], m[10][10], K[30][30];
    if (!fem_system_rows(body->mesh, system, e, rows, columns)) continue;
    fem_body_element(body, e, u, x, v);
    fem_tet10_tangent(body->element, body->material, (const double(*)[3])x, (const double(*)[3])v,
                      K);
    fem_tet10_mass(body->element, body->material->rho, (const double(*)[3])x, m);
    fem_tet10_soften(&body->rotation, (const double(*)[10])m, K);
    PetscCall(MatSetValuesBlocked(system->K, 10, rows, 10, columns, &K[0][0], ADD_VALUES));
  }
  PetscCall(MatAssemblyBegin(system->K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(system->K, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

void fem_body_stress(const fem_body *body, const double *u, double *stress) {
  for (int e = 0; e < body->mesh->n_elements; e++) {
    double x[10][3], v[10][3];
    fem_body_element(body, e, u, x, v);
    stress[e] = fem_tet10_stress(body->element, body->material, (const double(*)[3])x,
                                 (const double(*)[3])v);
  }
}
