#include "fem/body/pressure.h"

#include <string.h>

#include "fem/element/surface.h"
#include "mesh/base/vec3.h"

enum { FACE_DOFS = 3 * MESH_FACE_NODES };

/* Tangent vectors x,r and x,s at a point of the rule. */
static void tangents(const fem_face_rule *rule, int point, const double x[][3], double r[3],
                     double s[3]) {
  memset(r, 0, 3 * sizeof *r);
  memset(s, 0, 3 * sizeof *s);
  for (int i = 0; i < rule->nodes; i++)
    for (int d = 0; d < 3; d++) {
      r[d] += rule->gradient[point][i][0] * x[i][d];
      s[d] += rule->gradient[point][i][1] * x[i][d];
    }
}

void fem_face_pressure(const fem_face_rule *rule, double p, const double x[][3], double f[][3]) {
  memset(f, 0, (size_t)rule->nodes * sizeof *f);
  for (int q = 0; q < rule->n; q++) {
    double r[3], s[3], n[3];
    tangents(rule, q, x, r, s);
    vec3_cross(r, s, n);
    for (int i = 0; i < rule->nodes; i++)
      for (int d = 0; d < 3; d++) f[i][d] -= p * rule->weight[q] * rule->shape[q][i] * n[d];
  }
}

/* Add a skew block by v to nodes (i, j), and its transpose to nodes (j, i). Column b of the block
 * is e_b x v. Its element (a, b) is v_d, or -v_d if (a, b, d) is odd. */
static void add_skew_block(int order, int i, int j, const double v[3], double *K) {
  for (int d = 0; d < 3; d++) {
    int    b = (d + 1) % 3, c = (d + 2) % 3;
    double sign[2]  = {v[d], -v[d]};
    int    at[2][2] = {{b, c}, {c, b}};
    for (int k = 0; k < 2; k++) {
      int row = 3 * i + at[k][0], column = 3 * j + at[k][1];
      K[row * order + column] += sign[k];
      K[column * order + row] += sign[k];
    }
  }
}

void fem_face_pressure_stiffness(const fem_face_rule *rule, double p, const double x[][3],
                                 double *K) {
  const int n = rule->nodes, order = 3 * n;
  memset(K, 0, (size_t)(order * order) * sizeof *K);
  for (int q = 0; q < rule->n; q++) {
    double r[3], s[3];
    tangents(rule, q, x, r, s);
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) {
        double half = p * rule->weight[q] * rule->shape[q][i] / 2, v[3];
        for (int d = 0; d < 3; d++)
          v[d] = half * (rule->gradient[q][j][0] * s[d] - rule->gradient[q][j][1] * r[d]);
        add_skew_block(order, i, j, v, K);
      }
  }
}

/* Deformed coordinates of a face's nodes. */
static void face_at(const fem_body *body, int face, const double *u, double x[][3]) {
  const mesh_face_set *set = &body->mesh->set[MESH_LOAD];
  const int            n   = mesh_topology_of(body->mesh->kind)->face_nodes;
  fem_face_coordinates(body->mesh, set, face, x);
  for (int i = 0; u && i < n; i++)
    for (int d = 0; d < 3; d++) x[i][d] += u[3 * (size_t)set->nodes[n * face + i] + d];
}

static int n_faces(const fem_body *body) {
  return body->pressure == 0 ? 0 : body->mesh->set[MESH_LOAD].n;
}

PetscErrorCode fem_pressure_residual(const fem_body *body, const fem_system *system,
                                     const double *u, PetscScalar *out) {
  const mesh_face_set *set = &body->mesh->set[MESH_LOAD];
  fem_face_rule        rule;
  PetscFunctionBeginUser;
  PetscCall(fem_face_rule_create(body->mesh->kind, &rule));
  for (int face = 0; face < n_faces(body); face++) {
    double x[MESH_FACE_NODES][3], f[MESH_FACE_NODES][3];
    face_at(body, face, u, x);
    fem_face_pressure(&rule, body->pressure, (const double(*)[3])x, f);
    for (int i = 0; i < rule.nodes; i++) {
      const int node = set->nodes[rule.nodes * face + i];
      PetscInt  row  = system->row[node];
      fem_system_to_row(system, node, f[i], f[i]);
      for (int d = 0; d < 3 && row >= system->first && row < system->last; d++)
        out[3 * (row - system->first) + d] -= f[i][d];
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode fem_pressure_face_tangent(const fem_body *body, const double *u,
                                         const fem_system *system, int face, double *K) {
  fem_face_rule rule;
  double        x[MESH_FACE_NODES][3];
  PetscFunctionBeginUser;
  PetscCall(fem_face_rule_create(body->mesh->kind, &rule));
  face_at(body, face, u, x);
  fem_face_pressure_stiffness(&rule, body->pressure, (const double(*)[3])x, K);
  fem_system_turn(system, rule.nodes, body->mesh->set[MESH_LOAD].nodes + rule.nodes * (size_t)face,
                  K);
  PetscFunctionReturn(0);
}

PetscErrorCode fem_pressure_tangent(const fem_body *body, const double *u, fem_system *system) {
  const mesh_face_set *set = &body->mesh->set[MESH_LOAD];
  fem_face_rule        rule;
  PetscFunctionBeginUser;
  PetscCall(fem_face_rule_create(body->mesh->kind, &rule));
  for (int face = 0; face < n_faces(body); face++) {
    double   x[MESH_FACE_NODES][3], K[FACE_DOFS * FACE_DOFS];
    PetscInt rows[MESH_FACE_NODES], columns[MESH_FACE_NODES];
    for (int i = 0; i < rule.nodes; i++) {
      columns[i] = system->row[set->nodes[rule.nodes * face + i]];
      rows[i]    = columns[i] >= system->first && columns[i] < system->last ? columns[i] : -1;
    }
    face_at(body, face, u, x);
    fem_face_pressure_stiffness(&rule, body->pressure, (const double(*)[3])x, K);
    fem_system_turn(system, rule.nodes, set->nodes + rule.nodes * (size_t)face, K);
    PetscCall(MatSetValuesBlocked(system->K, rule.nodes, rows, rule.nodes, columns, K, ADD_VALUES));
  }
  PetscFunctionReturn(0);
}

double fem_pressure_energy(const fem_body *body, const double *state, const double *u) {
  const mesh_face_set *set = &body->mesh->set[MESH_LOAD];
  double               sum = 0;
  fem_face_rule        rule;
  if (n_faces(body) == 0 || fem_face_rule_create(body->mesh->kind, &rule) != 0) return 0;
  const int order = 3 * rule.nodes;
  for (int face = 0; face < n_faces(body); face++) {
    double x[MESH_FACE_NODES][3], K[FACE_DOFS * FACE_DOFS], v[FACE_DOFS];
    face_at(body, face, state, x);
    fem_face_pressure_stiffness(&rule, body->pressure, (const double(*)[3])x, K);
    for (int i = 0; i < order; i++)
      v[i] = u[3 * (size_t)set->nodes[rule.nodes * face + i / 3] + (size_t)(i % 3)];
    for (int i = 0; i < order; i++)
      for (int j = 0; j < order; j++) sum += v[i] * K[i * order + j] * v[j];
  }
  return sum;
}

PetscErrorCode fem_pressure_unbalanced(const fem_body *body, const double *u,
                                       double (*unbalanced)[3], double     load[3]) {
  const mesh_face_set *set = &body->mesh->set[MESH_LOAD];
  fem_face_rule        rule;
  PetscFunctionBeginUser;
  PetscCall(fem_face_rule_create(body->mesh->kind, &rule));
  for (int face = 0; face < n_faces(body); face++) {
    double x[MESH_FACE_NODES][3], f[MESH_FACE_NODES][3];
    face_at(body, face, u, x);
    fem_face_pressure(&rule, body->pressure, (const double(*)[3])x, f);
    for (int i = 0; i < 3 * rule.nodes; i++) {
      unbalanced[set->nodes[rule.nodes * face + i / 3]][i % 3] -= f[i / 3][i % 3];
      load[i % 3] += f[i / 3][i % 3];
    }
  }
  PetscFunctionReturn(0);
}
