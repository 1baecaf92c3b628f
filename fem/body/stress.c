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

/* What the mean at a node is taken over. */
typedef struct {
  extrapolation to[2];  /* from the rule of straight and of curved elements */
  int          *owner;  /* [n_nodes] region whose elements count; NULL: all elements do */
  double       *volume; /* [n_nodes] of the elements that count */
} recovery;

/* The stiffest of the materials at each node; of equal ones the first. */
static void find_owners(const fem_body *body, int *owner) {
  const mesh_fe *mesh = body->mesh;
  const int      n    = body->element->n;
  for (int i = 0; i < mesh->n_nodes; i++) owner[i] = -1;
  for (int i = 0; i < n * mesh->n_elements; i++) {
    int *own = &owner[mesh->connectivity[i]], here = mesh->region[i / n];
    if (*own < 0 || body->material[here].E > body->material[*own].E ||
        (body->material[here].E == body->material[*own].E && here < *own))
      *own = here;
  }
}

static PetscErrorCode recovery_create(const fem_body *body, recovery **out) {
  const mesh_fe       *mesh     = body->mesh;
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, out));
  PetscCall(PetscCalloc1(mesh->n_nodes, &(*out)->volume));
  fit(topology, &body->element->straight, &(*out)->to[0]);
  fit(topology, &body->element->curved, &(*out)->to[1]);
  if (mesh->region) {
    PetscCall(PetscMalloc1(mesh->n_nodes, &(*out)->owner));
    find_owners(body, (*out)->owner);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode recovery_destroy(recovery *r) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(r->volume));
  PetscCall(PetscFree(r->owner));
  PetscCall(PetscFree(r));
  PetscFunctionReturn(0);
}

static bool counts(const recovery *r, const mesh_fe *mesh, int element, int node) {
  return !r->owner || r->owner[node] == mesh->region[element];
}

PetscErrorCode fem_nodal_stress(const fem_body *body, const double *u,
                                double (*stress)[FEM_STRESSES]) {
  const mesh_fe *mesh = body->mesh;
  recovery      *r;

  PetscFunctionBeginUser;
  PetscCall(recovery_create(body, &r));
  memset(stress, 0, (size_t)mesh->n_nodes * sizeof *stress);
  for (int e = 0; e < mesh->n_elements; e++) {
    const int *node = mesh->connectivity + body->element->n * (size_t)e;
    double     x[MESH_NODES][3], v[MESH_NODES][3], nodal[MESH_NODES][FEM_STRESSES];
    fem_body_element(body, e, u, x, v);
    const fem_rule *rule = fem_element_stiffness_rule(body->element, (const double(*)[3])x);
    double          here =
        add_element(body, fem_material_at(body->material, mesh, e), (const double(*)[3])x,
                    (const double(*)[3])v, rule, &r->to[rule == &body->element->curved], nodal);
    for (int i = 0; i < body->element->n; i++) {
      if (!counts(r, mesh, e, node[i])) continue;
      r->volume[node[i]] += here;
      for (int c = 0; c < FEM_STRESSES; c++) stress[node[i]][c] += nodal[i][c];
    }
  }
  for (int i = 0; i < mesh->n_nodes; i++)
    for (int c = 0; c < FEM_STRESSES; c++) stress[i][c] /= r->volume[i];
  PetscCall(recovery_destroy(r));
  PetscFunctionReturn(0);
}

/* Motions at work on together. */
enum { LANES = 8 };

typedef double lanes[LANES];

/* Displacements of the nodes of an element in up to LANES motions, less those of its first node. */
static void gather(const fem_body *body, const int *node, int n, const double *motion,
                   lanes v[][3]) {
  const size_t stride = 3 * (size_t)body->mesh->n_nodes;
  memset(v, 0, (size_t)body->element->n * sizeof *v);
  for (int l = 0; l < n; l++) {
    const double *all = motion + (size_t)l * stride, *first = all + 3 * (size_t)node[0];
    for (int i = 1; i < body->element->n; i++)
      for (int a = 0; a < 3; a++) v[i][a][l] = all[3 * (size_t)node[i] + (size_t)a] - first[a];
  }
}

/* Changes of stress at a point of the rule. */
static void change_at(int n, const double D[6][9], const double g[][3], const lanes v[][3],
                      lanes stress[FEM_STRESSES]) {
  lanes H[9] = {{0}};
  for (int i = 1; i < n; i++)
    for (int a = 0; a < 3; a++)
      for (int d = 0; d < 3; d++)
        for (int l = 0; l < LANES; l++) H[3 * a + d][l] += v[i][a][l] * g[i][d];
  memset(stress, 0, FEM_STRESSES * sizeof *stress);
  for (int c = 0; c < FEM_STRESSES; c++)
    for (int h = 0; h < 9; h++)
      for (int l = 0; l < LANES; l++) stress[c][l] += D[c][h] * H[h][l];
}

/* Add an element's volume times its nodal stresses to the sums of the nodes. */
static void add_changes(const fem_body *body, int e, const double *u, int n, const double *motion,
                        recovery *r, lanes (*sum)[FEM_STRESSES]) {
  const mesh_fe      *mesh  = body->mesh;
  const fem_material *own   = fem_material_at(body->material, mesh, e);
  const int           nodes = body->element->n, *node = mesh->connectivity + nodes * (size_t)e;
  double              x[MESH_NODES][3], at_rest[MESH_NODES][3], volume = 0;
  lanes               v[MESH_NODES][3], stress[FEM_POINTS][FEM_STRESSES];
  fem_body_element(body, e, u, x, at_rest);
  gather(body, node, n, motion, v);
  const fem_rule      *rule = fem_element_stiffness_rule(body->element, (const double(*)[3])x);
  const extrapolation *to   = &r->to[rule == &body->element->curved];
  for (int p = 0; p < rule->n; p++) {
    fem_deformation at;
    double          g[MESH_NODES][3], H[3][3], D[6][9];
    volume +=
        rule->weight[p] * fem_element_gradient(body->element, rule, p, (const double(*)[3])x, g);
    fem_displacement_gradient(nodes, (const double(*)[3])g, (const double(*)[3])at_rest, H);
    fem_deformation_at(own, (const double(*)[3])H, &at);
    fem_cauchy_tangent(own, &at, D);
    change_at(nodes, (const double(*)[9])D, (const double(*)[3])g, (const lanes(*)[3])v, stress[p]);
  }
  for (int i = 0; i < nodes; i++) {
    if (!counts(r, mesh, e, node[i])) continue;
    r->volume[node[i]] += volume;
    for (int p = 0; p < rule->n; p++) {
      const double weight = volume * to->at[i][p];
      for (int c = 0; c < FEM_STRESSES; c++)
        for (int l = 0; l < LANES; l++) sum[node[i]][c][l] += weight * stress[p][c][l];
    }
  }
}

PetscErrorCode fem_nodal_stress_change(const fem_body *body, const double *u, int n,
                                       const double *motion, float *stress) {
  const size_t nodes = (size_t)body->mesh->n_nodes;
  recovery    *r;
  lanes(*sum)[FEM_STRESSES];

  PetscFunctionBeginUser;
  PetscCall(recovery_create(body, &r));
  PetscCall(PetscMalloc1(nodes, &sum));
  for (int first = 0; first < n; first += LANES) {
    const int count = PetscMin(LANES, n - first);
    memset(sum, 0, nodes * sizeof *sum);
    memset(r->volume, 0, nodes * sizeof *r->volume);
    for (int e = 0; e < body->mesh->n_elements; e++)
      add_changes(body, e, u, count, motion + 3 * nodes * (size_t)first, r, sum);
    for (int l = 0; l < count; l++) {
      float *out = stress + FEM_STRESSES * nodes * (size_t)(first + l);
      for (size_t i = 0; i < nodes; i++)
        for (int c = 0; c < FEM_STRESSES; c++)
          out[FEM_STRESSES * i + (size_t)c] = (float)(sum[i][c][l] / r->volume[i]);
    }
  }
  PetscCall(PetscFree(sum));
  PetscCall(recovery_destroy(r));
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
