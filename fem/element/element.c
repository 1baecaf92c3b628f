#include "fem/element/element.h"

#include <math.h>
#include <string.h>

/* Inlined, so that each number of nodes is compiled separately. */
#define KERNEL static inline __attribute__((always_inline))

fem_lame fem_lame_of(const fem_material *material) {
  double mu = material->E / (2 * (1 + material->nu)), nu = material->nu;
  return (fem_lame){.lambda = 2 * mu * nu / (1 - 2 * nu), .mu = mu};
}

KERNEL void mass_sum(int n, const fem_rule *rule, const double *scale, double *m) {
  memset(m, 0, (size_t)(n * n) * sizeof *m);
  for (int p = 0; p < rule->n; p++) {
    double factor = rule->weight[p] * scale[p];
    for (int i = 0; i < n; i++) {
      double weighted = factor * rule->shape[p][i];
      for (int j = i; j < n; j++) m[n * i + j] += weighted * rule->shape[p][j];
    }
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++) m[n * i + j] = m[n * j + i];
}

static void mass_of(const fem_element *element, const double *scale, double *m) {
  if (element->n == 10)
    mass_sum(10, &element->mass, scale, m);
  else
    mass_sum(20, &element->mass, scale, m);
}

static PetscErrorCode create_rules(fem_element *element) {
  const fem_rules rules = element->rules;
  PetscFunctionBeginUser;
  if (element->kind == MESH_HEX20) {
    PetscCall(fem_hex_rule(rules == FEM_FULL ? 3 : 2, &element->straight));
    PetscCall(fem_hex_rule(rules == FEM_FULL ? 3 : 2, &element->curved));
    PetscCall(fem_hex_rule(rules == FEM_CALCULIX ? 2 : 3, &element->mass));
    PetscFunctionReturn(0);
  }
  fem_tet_rule_4(&element->straight);
  fem_tet_rule_4(&element->curved);
  fem_tet_rule_4(&element->mass);
  if (rules == FEM_FULL) PetscCall(fem_tet_rule_conical(3, &element->curved));
  if (rules != FEM_CALCULIX) PetscCall(fem_tet_rule_conical(4, &element->mass));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_element_create(mesh_kind kind, fem_rules rules, fem_element *element) {
  double one[FEM_POINTS];
  PetscFunctionBeginUser;
  element->kind  = kind;
  element->n     = mesh_topology_of(kind)->nodes;
  element->rules = rules;
  PetscCall(create_rules(element));
  for (int p = 0; p < FEM_POINTS; p++) one[p] = 1;
  mass_of(element, one, element->reference_mass);
  PetscFunctionReturn(0);
}

/* Compares each node with the affine map of corner 0 and its three neighbours. */
bool fem_element_is_straight(const fem_element *element, const double x[][3]) {
  const mesh_topology *topology = mesh_topology_of(element->kind);
  double               side[3][3], length = 0;
  for (int a = 0; a < 3; a++)
    for (int d = 0; d < 3; d++) side[a][d] = x[topology->along[a]][d] - x[0][d];
  for (int d = 0; d < 3; d++) length += side[0][d] * side[0][d];
  for (int i = 1; i < element->n; i++) {
    const double *r   = topology->place[i];
    double        off = 0;
    for (int d = 0; d < 3; d++) {
      double sag = x[i][d] - x[0][d] - r[0] * side[0][d] - r[1] * side[1][d] - r[2] * side[2][d];
      off += sag * sag;
    }
    if (off > 1e-18 * length) return false;
  }
  return true;
}

/* Determinant of J[a][d] = dx_d / d(reference a).
 *   inverse  out  [d][a] = d(reference a)/dx_d; may be NULL */
static double jacobian(int n, const double x[][3], const double gradient[][3],
                       double inverse[3][3]) {
  double J[3][3] = {{0}};
  for (int i = 0; i < n; i++)
    for (int a = 0; a < 3; a++)
      for (int d = 0; d < 3; d++) J[a][d] += gradient[i][a] * x[i][d];
  double cofactor[3][3];
  for (int a = 0; a < 3; a++)
    for (int d = 0; d < 3; d++) {
      int a1 = (a + 1) % 3, a2 = (a + 2) % 3, d1 = (d + 1) % 3, d2 = (d + 2) % 3;
      cofactor[a][d] = J[a1][d1] * J[a2][d2] - J[a1][d2] * J[a2][d1];
    }
  double det = J[0][0] * cofactor[0][0] + J[0][1] * cofactor[0][1] + J[0][2] * cofactor[0][2];
  if (inverse)
    for (int a = 0; a < 3; a++)
      for (int d = 0; d < 3; d++) inverse[d][a] = cofactor[a][d] / det;
  return det;
}

const fem_rule *fem_element_stiffness_rule(const fem_element *element, const double x[][3]) {
  return fem_element_is_straight(element, x) ? &element->straight : &element->curved;
}

double fem_element_gradient(const fem_element *element, const fem_rule *rule, int point,
                            const double x[][3], double g[][3]) {
  const double(*reference)[3] = rule->gradient[point];
  double inverse[3][3], det = jacobian(element->n, x, reference, inverse);
  for (int i = 0; i < element->n; i++)
    for (int d = 0; d < 3; d++)
      g[i][d] = inverse[d][0] * reference[i][0] + inverse[d][1] * reference[i][1] +
                inverse[d][2] * reference[i][2];
  return det;
}

/* For an isotropic D, B^T D B of nodes i, j is lambda g_i g_j^T + mu g_j g_i^T + mu (g_i . g_j)
 * I. */
KERNEL void add_point(int n, double lambda, double mu, const double g[][3], double *K) {
  for (int i = 0; i < n; i++)
    for (int j = i; j < n; j++) {
      double inner = mu * (g[i][0] * g[j][0] + g[i][1] * g[j][1] + g[i][2] * g[j][2]);
      for (int a = 0; a < 3; a++) {
        double *row = K + (size_t)((3 * i + a) * 3 * n + 3 * j);
        for (int b = 0; b < 3; b++) row[b] += lambda * g[i][a] * g[j][b] + mu * g[i][b] * g[j][a];
        row[a] += inner;
      }
    }
}

void fem_strain_rows(const double F[3][3], const double g[3], double B[6][3]) {
  for (int a = 0; a < 3; a++) {
    for (int i = 0; i < 3; i++) B[i][a] = F[a][i] * g[i];
    B[3][a] = F[a][0] * g[1] + F[a][1] * g[0];
    B[4][a] = F[a][0] * g[2] + F[a][2] * g[0];
    B[5][a] = F[a][1] * g[2] + F[a][2] * g[1];
  }
}

void fem_add_anisotropic(int n, const double C[6][6], double volume, const double F[3][3],
                         const double g[][3], double *K) {
  double B[MESH_NODES][6][3], CB[6][3];
  for (int i = 0; i < n; i++) fem_strain_rows(F, g[i], B[i]);
  for (int j = 0; j < n; j++) {
    for (int p = 0; p < 6; p++)
      for (int b = 0; b < 3; b++) {
        CB[p][b] = 0;
        for (int q = 0; q < 6; q++) CB[p][b] += volume * C[p][q] * B[j][q][b];
      }
    for (int i = 0; i <= j; i++)
      for (int a = 0; a < 3; a++)
        for (int p = 0; p < 6; p++)
          for (int b = 0; b < 3; b++) K[(3 * i + a) * 3 * n + 3 * j + b] += B[i][p][a] * CB[p][b];
  }
}

void fem_element_stiffness(const fem_element *element, const fem_material *material,
                           const double x[][3], double *K) {
  const fem_rule *rule = fem_element_stiffness_rule(element, x);
  const fem_lame  lame = fem_lame_of(material);
  const int       n = element->n, order = 3 * n;
  const double    identity[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  memset(K, 0, (size_t)(order * order) * sizeof *K);
  for (int p = 0; p < rule->n; p++) {
    double       g[MESH_NODES][3];
    const double volume  = rule->weight[p] * fem_element_gradient(element, rule, p, x, g);
    const double(*at)[3] = (const double(*)[3])g;
    const double lambda = lame.lambda * volume, mu = lame.mu * volume;
    if (material->anisotropic)
      fem_add_anisotropic(n, material->C, volume, identity, at, K);
    else if (n == 10)
      add_point(10, lambda, mu, at, K);
    else
      add_point(20, lambda, mu, at, K);
  }
  for (int i = 0; i < order; i++)
    for (int j = 0; j < i; j++) K[order * i + j] = K[order * j + i];
}

void fem_element_mass(const fem_element *element, double rho, const double x[][3], double *m) {
  const fem_rule *rule = &element->mass;
  const int       n    = element->n;
  if (fem_element_is_straight(element, x)) {
    double scale = rho * jacobian(n, x, element->straight.gradient[0], NULL);
    for (int i = 0; i < n * n; i++) m[i] = scale * element->reference_mass[i];
    return;
  }
  double scale[FEM_POINTS];
  for (int p = 0; p < rule->n; p++) scale[p] = rho * jacobian(n, x, rule->gradient[p], NULL);
  mass_of(element, scale, m);
}
