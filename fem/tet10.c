#include "fem/tet10.h"

#include <math.h>
#include <string.h>

static const int edge_of[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};

fem_lame fem_lame_of(const fem_material *material) {
  double mu = material->E / (2 * (1 + material->nu)), nu = material->nu;
  return (fem_lame){.lambda = 2 * mu * nu / (1 - 2 * nu), .mu = mu};
}

static void mass_sum(const fem_tet_rule *rule, const double *scale, double m[10][10]) {
  memset(m, 0, 100 * sizeof(double));
  for (int p = 0; p < rule->n; p++) {
    double factor = rule->weight[p] * scale[p];
    for (int i = 0; i < 10; i++) {
      double weighted = factor * rule->shape[p][i];
      for (int j = i; j < 10; j++) m[i][j] += weighted * rule->shape[p][j];
    }
  }
  for (int i = 0; i < 10; i++)
    for (int j = 0; j < i; j++) m[i][j] = m[j][i];
}

PetscErrorCode fem_tet10_create(fem_mass_rule mass, fem_tet10 *element) {
  PetscFunctionBeginUser;
  element->mass = mass;
  fem_tet_rule_4(&element->straight);
  PetscCall(fem_tet_rule_conical(3, &element->curved));
  PetscCall(fem_tet_rule_conical(4, &element->full));
  double one[FEM_TET_POINTS];
  for (int p = 0; p < FEM_TET_POINTS; p++) one[p] = 1;
  mass_sum(mass == FEM_MASS_EXACT ? &element->full : &element->straight, one,
           element->reference_mass);
  PetscFunctionReturn(0);
}

bool fem_tet10_is_straight(const double x[10][3]) {
  for (int e = 0; e < 6; e++) {
    const double *a = x[edge_of[e][0]], *b = x[edge_of[e][1]], *middle = x[4 + e];
    double        off = 0, length = 0;
    for (int d = 0; d < 3; d++) {
      double sag = middle[d] - (a[d] + b[d]) / 2;
      off += sag * sag;
      length += (b[d] - a[d]) * (b[d] - a[d]);
    }
    if (off > 1e-18 * length) return false;
  }
  return true;
}

/* J[a][d] = dx_d / d(reference a), its determinant, and (if inverse) inverse[d][a] = d(reference a)/dx_d. */
static double jacobian(const double x[10][3], const double gradient[10][3], double inverse[3][3]) {
  double J[3][3] = {{0}};
  for (int i = 0; i < 10; i++)
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

const fem_tet_rule *fem_tet10_stiffness_rule(const fem_tet10 *element, const double x[10][3]) {
  return fem_tet10_is_straight(x) ? &element->straight : &element->curved;
}

double fem_tet10_gradient(const fem_tet_rule *rule, int point, const double x[10][3],
                          double g[10][3]) {
  const double(*reference)[3] = rule->gradient[point];
  double inverse[3][3], det = jacobian(x, reference, inverse);
  for (int i = 0; i < 10; i++)
    for (int d = 0; d < 3; d++)
      g[i][d] = inverse[d][0] * reference[i][0] + inverse[d][1] * reference[i][1] +
                inverse[d][2] * reference[i][2];
  return det;
}

/* B^T D B of nodes i, j for an isotropic D is lambda g_i g_j^T + mu g_j g_i^T + mu (g_i . g_j) I. */
static void add_point(double lambda, double mu, const double g[10][3], double K[30][30]) {
  for (int i = 0; i < 10; i++)
    for (int j = i; j < 10; j++) {
      double inner = mu * (g[i][0] * g[j][0] + g[i][1] * g[j][1] + g[i][2] * g[j][2]);
      for (int a = 0; a < 3; a++) {
        for (int b = 0; b < 3; b++)
          K[3 * i + a][3 * j + b] += lambda * g[i][a] * g[j][b] + mu * g[i][b] * g[j][a];
        K[3 * i + a][3 * j + a] += inner;
      }
    }
}

void fem_tet10_stiffness(const fem_tet10 *element, const fem_material *material,
                         const double x[10][3], double K[30][30]) {
  const fem_tet_rule *rule = fem_tet10_stiffness_rule(element, x);
  const fem_lame      lame = fem_lame_of(material);
  memset(K, 0, 900 * sizeof(double));
  for (int p = 0; p < rule->n; p++) {
    double g[10][3], volume = rule->weight[p] * fem_tet10_gradient(rule, p, x, g);
    add_point(lame.lambda * volume, lame.mu * volume, g, K);
  }
  for (int i = 0; i < 30; i++)
    for (int j = 0; j < i; j++) K[i][j] = K[j][i];
}

void fem_tet10_mass(const fem_tet10 *element, double rho, const double x[10][3], double m[10][10]) {
  const fem_tet_rule *rule = element->mass == FEM_MASS_EXACT ? &element->full : &element->straight;
  if (fem_tet10_is_straight(x)) {
    double scale = rho * jacobian(x, element->straight.gradient[0], NULL);
    for (int i = 0; i < 10; i++)
      for (int j = 0; j < 10; j++) m[i][j] = scale * element->reference_mass[i][j];
    return;
  }
  double scale[FEM_TET_POINTS];
  for (int p = 0; p < rule->n; p++) scale[p] = rho * jacobian(x, rule->gradient[p], NULL);
  mass_sum(rule, scale, m);
}
