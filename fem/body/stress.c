#include "fem/body/stress.h"

#include <string.h>

#include "fem/body/pressure.h"
#include "fem/element/finite_strain.h"

/* Extrapolation from the points of a rule to the nodes by a linear function of the reference
 * coordinates: node value = sum_p at[node][p] value_p. */
typedef struct {
  double at[MESH_NODES][FEM_POINTS];
} extrapolation;

/* Inverse of a symmetric positive definite 4x4 matrix by Gauss-Jordan elimination. */
static void invert(double A[4][4], double X[4][4]) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) X[i][j] = i == j;
  for (int c = 0; c < 4; c++) {
    double pivot = A[c][c];
    for (int j = 0; j < 4; j++) A[c][j] /= pivot, X[c][j] /= pivot;
    for (int i = 0; i < 4; i++) {
      double factor = i == c ? 0 : A[i][c];
      for (int j = 0; j < 4; j++) A[i][j] -= factor * A[c][j], X[i][j] -= factor * X[c][j];
    }
  }
}

/* Basis (1, r, s, t) at a point with these shape functions. */
static void linear_at(const mesh_topology *topology, const double *shape, double b[4]) {
  b[0] = 1;
  b[1] = b[2] = b[3] = 0;
  for (int i = 0; i < topology->nodes; i++)
    for (int d = 0; d < 3; d++) b[d + 1] += shape[i] * topology->place[i][d];
}

static void fit(const mesh_topology *topology, const fem_rule *rule, extrapolation *out) {
  double normal[4][4] = {{0}}, inverse[4][4];
  for (int p = 0; p < rule->n; p++) {
    double b[4];
    linear_at(topology, rule->shape[p], b);
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) normal[i][j] += b[i] * b[j];
  }
  invert(normal, inverse);
  for (int node = 0; node < topology->nodes; node++) {
    const double *place = topology->place[node], a[4] = {1, place[0], place[1], place[2]};
    for (int p = 0; p < rule->n; p++) {
      double b[4], sum = 0;
      linear_at(topology, rule->shape[p], b);
      for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) sum += a[i] * inverse[i][j] * b[j];
      out->at[node][p] = sum;
    }
  }
}

/* Volume of the element times its nodal stresses. Returns the volume. */
static double add_element(const fem_body *body, const fem_material *own, const double x[][3],
                          const double u[][3], const fem_rule *rule, const extrapolation *to,
                          double nodal[][FEM_STRESSES]) {
  double volume = 0, stress[FEM_POINTS][FEM_STRESSES];
  for (int p = 0; p < rule->n; p++) {
    fem_deformation at;
    double          g[MESH_NODES][3], H[3][3];
    volume += rule->weight[p] * fem_element_gradient(body->element, rule, p, x, g);
    fem_displacement_gradient(body->element->n, (const double(*)[3])g, u, H);
    fem_deformation_at(own, (const double(*)[3])H, &at);
    fem_cauchy(&at, stress[p]);
  }
  for (int i = 0; i < body->element->n; i++)
    for (int c = 0; c < FEM_STRESSES; c++) {
      nodal[i][c] = 0;
      for (int p = 0; p < rule->n; p++) nodal[i][c] += to->at[i][p] * stress[p][c];
      nodal[i][c] *= volume;
    }
  return volume;
}

PetscErrorCode fem_nodal_stress(const fem_body *body, const double *u,
                                double (*stress)[FEM_STRESSES]) {
  const mesh_fe       *mesh     = body->mesh;
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  extrapolation       *to;
  double              *volume;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes, &volume));
  PetscCall(PetscMalloc1(2, &to));
  fit(topology, &body->element->straight, &to[0]);
  fit(topology, &body->element->curved, &to[1]);
  memset(stress, 0, (size_t)mesh->n_nodes * sizeof *stress);
  for (int e = 0; e < mesh->n_elements; e++) {
    const int *node = mesh->connectivity + body->element->n * (size_t)e;
    double     x[MESH_NODES][3], v[MESH_NODES][3], nodal[MESH_NODES][FEM_STRESSES];
    fem_body_element(body, e, u, x, v);
    const fem_rule *rule = fem_element_stiffness_rule(body->element, (const double(*)[3])x);
    double          here =
        add_element(body, fem_material_at(body->material, mesh, e), (const double(*)[3])x,
                    (const double(*)[3])v, rule, &to[rule == &body->element->curved], nodal);
    for (int i = 0; i < body->element->n; i++) {
      volume[node[i]] += here;
      for (int c = 0; c < FEM_STRESSES; c++) stress[node[i]][c] += nodal[i][c];
    }
  }
  for (int i = 0; i < mesh->n_nodes; i++)
    for (int c = 0; c < FEM_STRESSES; c++) stress[i][c] /= volume[i];
  PetscCall(PetscFree(volume));
  PetscCall(PetscFree(to));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_unbalanced_forces(const fem_body *body, const double *u, double (*unbalanced)[3],
                                     double load[3]) {
  const int n = body->element->n;
  PetscFunctionBeginUser;
  memset(unbalanced, 0, (size_t)body->mesh->n_nodes * sizeof *unbalanced);
  memset(load, 0, 3 * sizeof *load);
  for (int e = 0; e < body->mesh->n_elements; e++) {
    const int *node = body->mesh->connectivity + n * (size_t)e;
    double     x[MESH_NODES][3], v[MESH_NODES][3], internal[MESH_NODES][3], outer[MESH_NODES][3];
    double     m[MESH_NODES * MESH_NODES];

    const fem_material *own = fem_material_at(body->material, body->mesh, e);
    fem_body_element(body, e, u, x, v);
    const double(*at)[3] = (const double(*)[3])x, (*by)[3] = (const double(*)[3])v;
    fem_element_force(body->element, own, at, by, internal);
    fem_element_mass(body->element, own->rho, at, m);
    fem_rotation_load(&body->rotation, n, m, at, by, outer);
    for (int i = 0; i < 3 * n; i++) {
      unbalanced[node[i / 3]][i % 3] += internal[i / 3][i % 3] - outer[i / 3][i % 3];
      load[i % 3] += outer[i / 3][i % 3];
    }
  }
  PetscCall(fem_pressure_unbalanced(body, u, unbalanced, load));
  PetscFunctionReturn(0);
}
