#include "fem/body/rigid_body.h"

#include "mesh/base/vec3.h"

/* Velocity of rigid motion r at a point x. */
static void rigid_motion(int r, const double axis[3], const double x[3], double v[3]) {
  for (int d = 0; d < 3; d++) v[d] = r == d;
  if (r == 3) vec3_cross(axis, x, v);
}

/* f_i = sum_j m_ij r(x_j). Returns sum_ij r_i m_ij r_j. */
static double element_load(int n, int r, const double *m, const double axis[3], const double x[][3],
                           double f[][3]) {
  double v[MESH_NODES][3], sum = 0;
  for (int i = 0; i < n; i++) rigid_motion(r, axis, x[i], v[i]);
  for (int i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) {
      f[i][d] = 0;
      for (int j = 0; j < n; j++) f[i][d] += m[n * i + j] * v[j][d];
      sum += v[i][d] * f[i][d];
    }
  return sum;
}

/* Does this rank count the element in the sums? The owner of its first free node does; rank 0 if it
 * has none. */
static bool counts(const fem_system *system, int n, const PetscInt *columns, int rank) {
  for (int i = 0; i < n; i++)
    if (columns[i] >= 0) return columns[i] >= system->first && columns[i] < system->last;
  return rank == 0;
}

PetscErrorCode fem_rigid_load(const fem_body *body, const double *u, const fem_system *system,
                              Vec load[FEM_RIGID], double inertia[FEM_RIGID]) {
  const int    n = body->element->n;
  PetscScalar *out[FEM_RIGID];
  double       axis[3], sum[FEM_RIGID] = {0};
  int          rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(system->comm, &rank));
  mesh_axis_vector(body->rotation.axis, axis);
  for (int r = 0; r < FEM_RIGID; r++) {
    PetscCall(VecZeroEntries(load[r]));
    PetscCall(VecGetArray(load[r], &out[r]));
  }
  for (int e = 0; e < body->mesh->n_elements; e++) {
    PetscInt   rows[MESH_NODES], columns[MESH_NODES];
    double     x[MESH_NODES][3], v[MESH_NODES][3], f[MESH_NODES][3], m[MESH_NODES * MESH_NODES];
    const bool touches = fem_system_rows(body->mesh, system, e, rows, columns);
    const bool counted = counts(system, n, columns, rank);
    if (!touches && !counted) continue;
    fem_body_element(body, e, u, x, v);
    fem_element_mass(body->element, fem_material_at(body->material, body->mesh, e)->rho,
                     (const double(*)[3])x, m);
    for (int i = 0; i < 3 * n; i++) x[i / 3][i % 3] += v[i / 3][i % 3];
    for (int r = 0; r < FEM_RIGID; r++) {
      double whole = element_load(n, r, m, axis, (const double(*)[3])x, f);
      if (counted) sum[r] += whole;
      for (int i = 0; i < n; i++)
        fem_system_to_row(system, body->mesh->connectivity[n * (size_t)e + (size_t)i], f[i], f[i]);
      for (int i = 0; i < 3 * n; i++)
        if (rows[i / 3] >= 0) out[r][3 * (rows[i / 3] - system->first) + i % 3] += f[i / 3][i % 3];
    }
  }
  for (int r = 0; r < FEM_RIGID; r++) PetscCall(VecRestoreArray(load[r], &out[r]));
  PetscCallMPI(MPI_Allreduce(sum, inertia, FEM_RIGID, MPI_DOUBLE, MPI_SUM, system->comm));
  PetscFunctionReturn(0);
}
