#include "fem/body/tangent.h"

#include "fem/body/pressure.h"
#include "fem/element/finite_strain.h"

PetscErrorCode fem_residual_assemble(const fem_body *body, const fem_system *system,
                                     const double *u, Vec R) {
  const int    n = body->element->n;
  PetscScalar *out;

  PetscFunctionBeginUser;
  PetscCall(VecZeroEntries(R));
  PetscCall(VecGetArray(R, &out));
  for (int e = 0; e < body->mesh->n_elements; e++) {
    PetscInt rows[MESH_NODES], columns[MESH_NODES];
    double   x[MESH_NODES][3], v[MESH_NODES][3], m[MESH_NODES * MESH_NODES];
    double   internal[MESH_NODES][3], load[MESH_NODES][3];

    const fem_material *own = fem_material_at(body->material, body->mesh, e);
    if (!fem_system_rows(body->mesh, system, e, rows, columns)) continue;
    fem_body_element(body, e, u, x, v);
    const double(*at)[3] = (const double(*)[3])x, (*by)[3] = (const double(*)[3])v;
    fem_element_force(body->element, own, at, by, internal);
    fem_element_mass(body->element, own->rho, at, m);
    fem_rotation_load(&body->rotation, n, m, at, by, load);
    const int *node = body->mesh->connectivity + n * (size_t)e;
    for (int i = 0; i < n; i++) {
      double unbalanced[3];
      for (int d = 0; d < 3; d++) unbalanced[d] = internal[i][d] - load[i][d];
      fem_system_to_row(system, node[i], unbalanced, unbalanced);
      for (int d = 0; d < 3 && rows[i] >= 0; d++)
        out[3 * (rows[i] - system->first) + d] += unbalanced[d];
    }
  }
  PetscCall(fem_pressure_residual(body, system, u, out));
  PetscCall(VecRestoreArray(R, &out));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_tangent_assemble(const fem_body *body, const double *u, fem_system *system) {
  const int n = body->element->n;
  PetscFunctionBeginUser;
  PetscCall(MatZeroEntries(system->K));
  for (int e = 0; e < body->mesh->n_elements; e++) {
    PetscInt rows[MESH_NODES], columns[MESH_NODES];
    double   x[MESH_NODES][3], v[MESH_NODES][3], m[MESH_NODES * MESH_NODES];
    double   K[FEM_DOFS * FEM_DOFS];

    const fem_material *own = fem_material_at(body->material, body->mesh, e);
    if (!fem_system_rows(body->mesh, system, e, rows, columns)) continue;
    fem_body_element(body, e, u, x, v);
    fem_element_tangent(body->element, own, (const double(*)[3])x, (const double(*)[3])v, K);
    fem_element_mass(body->element, own->rho, (const double(*)[3])x, m);
    fem_rotation_soften(&body->rotation, n, m, K);
    fem_system_turn(system, n, body->mesh->connectivity + n * (size_t)e, K);
    PetscCall(MatSetValuesBlocked(system->K, n, rows, n, columns, K, ADD_VALUES));
  }
  PetscCall(fem_pressure_tangent(body, u, system));
  PetscCall(MatAssemblyBegin(system->K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(system->K, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

void fem_body_stress(const fem_body *body, const double *u, double *stress) {
  for (int e = 0; e < body->mesh->n_elements; e++) {
    double x[MESH_NODES][3], v[MESH_NODES][3];
    fem_body_element(body, e, u, x, v);
    stress[e] = fem_element_stress(body->element, fem_material_at(body->material, body->mesh, e),
                                   (const double(*)[3])x, (const double(*)[3])v);
  }
}
