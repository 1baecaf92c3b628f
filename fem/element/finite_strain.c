#include "fem/element/finite_strain.h"

#include <math.h>
#include <string.h>

#include "mesh/base/vec3.h"

/* Inlined, so that each number of nodes is compiled separately. */
#define KERNEL static inline __attribute__((always_inline))

void fem_displacement_gradient(int n, const double g[][3], const double u[][3], double H[3][3]) {
  memset(H, 0, 9 * sizeof(double));
  for (int i = 1; i < n; i++) /* relative to node 0, so that a translation cancels */
    for (int a = 0; a < 3; a++)
      for (int d = 0; d < 3; d++) H[a][d] += (u[i][a] - u[0][a]) * g[i][d];
}

/* S = C E */
static void anisotropic_stress(const fem_material *material, const double E[3][3], double S[3][3]) {
  const double strain[6] = {E[0][0], E[1][1], E[2][2], 2 * E[0][1], 2 * E[0][2], 2 * E[1][2]};
  double       stress[6] = {0};
  for (int p = 0; p < 6; p++)
    for (int q = 0; q < 6; q++) stress[p] += material->C[p][q] * strain[q];
  for (int a = 0; a < 3; a++) S[a][a] = stress[a];
  S[0][1] = S[1][0] = stress[3];
  S[0][2] = S[2][0] = stress[4];
  S[1][2] = S[2][1] = stress[5];
}

/* E is computed from H. F^T F - I would lose the digits of small strains. */
void fem_deformation_at(const fem_material *material, const double H[3][3], fem_deformation *at) {
  const fem_lame lame = fem_lame_of(material);
  double         E[3][3], trace;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      double square = H[0][a] * H[0][b] + H[1][a] * H[1][b] + H[2][a] * H[2][b];
      E[a][b]       = (H[a][b] + H[b][a] + square) / 2;
      at->F[a][b]   = H[a][b] + (a == b);
    }
  if (material->anisotropic) {
    anisotropic_stress(material, (const double(*)[3])E, at->S);
    return;
  }
  trace = E[0][0] + E[1][1] + E[2][2];
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      at->S[a][b] = 2 * lame.mu * E[a][b] + (a == b ? lame.lambda * trace : 0);
}

static void multiply(const double A[3][3], const double B[3][3], double C[3][3]) {
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) C[a][b] = A[a][0] * B[0][b] + A[a][1] * B[1][b] + A[a][2] * B[2][b];
}

static void apply(const double A[3][3], const double v[3], double out[3]) {
  for (int a = 0; a < 3; a++) out[a] = vec3_dot(A[a], v);
}

/* F F^T */
static void left_cauchy(const double F[3][3], double B[3][3]) {
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) B[a][b] = F[a][0] * F[b][0] + F[a][1] * F[b][1] + F[a][2] * F[b][2];
}

void fem_element_force(const fem_element *element, const fem_material *material,
                       const double x[][3], const double u[][3], double f[][3]) {
  const fem_rule *rule = fem_element_stiffness_rule(element, x);
  memset(f, 0, (size_t)element->n * sizeof *f);
  for (int p = 0; p < rule->n; p++) {
    fem_deformation at;
    double          g[MESH_NODES][3], H[3][3], P[3][3], nodal[3];
    double          volume = rule->weight[p] * fem_element_gradient(element, rule, p, x, g);
    fem_displacement_gradient(element->n, (const double(*)[3])g, u, H);
    fem_deformation_at(material, (const double(*)[3])H, &at);
    multiply((const double(*)[3])at.F, (const double(*)[3])at.S, P);
    for (int i = 0; i < element->n; i++) {
      apply((const double(*)[3])P, g[i], nodal);
      for (int d = 0; d < 3; d++) f[i][d] += volume * nodal[d];
    }
  }
}

/* Add the contribution of one point to the upper triangle. */
KERNEL void add_point(int n, const fem_lame *lame, double volume, const fem_deformation *at,
                      const double g[][3], double *K) {
  const double lambda = volume * lame->lambda, mu = volume * lame->mu;
  double       B[3][3], p[MESH_NODES][3], Sg[MESH_NODES][3];
  left_cauchy(at->F, B);
  for (int i = 0; i < n; i++) {
    apply(at->F, g[i], p[i]);
    apply(at->S, g[i], Sg[i]);
  }
  for (int i = 0; i < n; i++)
    for (int j = i; j < n; j++) {
      double geometric = volume * vec3_dot(g[i], Sg[j]), shear = mu * vec3_dot(g[i], g[j]);
      for (int a = 0; a < 3; a++) {
        double *row = K + (size_t)((3 * i + a) * 3 * n + 3 * j);
        for (int b = 0; b < 3; b++)
          row[b] += lambda * p[i][a] * p[j][b] + mu * p[j][a] * p[i][b] + shear * B[a][b];
        row[a] += geometric;
      }
    }
}

static void add_anisotropic(int n, const fem_material *material, double volume,
                            const fem_deformation *at, const double g[][3], double *K) {
  fem_add_anisotropic(n, material->C, volume, at->F, g, K);
  for (int j = 0; j < n; j++) {
    double Sg[3];
    apply(at->S, g[j], Sg);
    for (int i = 0; i <= j; i++)
      for (int a = 0; a < 3; a++) K[(3 * i + a) * 3 * n + 3 * j + a] += volume * vec3_dot(g[i], Sg);
  }
}

void fem_element_tangent(const fem_element *element, const fem_material *material,
                         const double x[][3], const double u[][3], double *K) {
  const fem_rule *rule  = fem_element_stiffness_rule(element, x);
  const fem_lame  lame  = fem_lame_of(material);
  const int       order = 3 * element->n;
  memset(K, 0, (size_t)(order * order) * sizeof *K);
  for (int p = 0; p < rule->n; p++) {
    fem_deformation at;
    double          g[MESH_NODES][3], H[3][3];
    double          volume = rule->weight[p] * fem_element_gradient(element, rule, p, x, g);
    fem_displacement_gradient(element->n, (const double(*)[3])g, u, H);
    fem_deformation_at(material, (const double(*)[3])H, &at);
    if (material->anisotropic)
      add_anisotropic(element->n, material, volume, &at, (const double(*)[3])g, K);
    else if (element->n == 10)
      add_point(10, &lame, volume, &at, (const double(*)[3])g, K);
    else
      add_point(20, &lame, volume, &at, (const double(*)[3])g, K);
  }
  for (int i = 0; i < order; i++)
    for (int j = 0; j < i; j++) K[order * i + j] = K[order * j + i];
}

static double determinant(const double A[3][3]) {
  return A[0][0] * (A[1][1] * A[2][2] - A[1][2] * A[2][1]) -
         A[0][1] * (A[1][0] * A[2][2] - A[1][2] * A[2][0]) +
         A[0][2] * (A[1][0] * A[2][1] - A[1][1] * A[2][0]);
}

void fem_cauchy(const fem_deformation *at, double stress[6]) {
  static const int place[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  double           P[3][3], J = determinant(at->F);
  multiply(at->F, at->S, P);
  for (int c = 0; c < 6; c++) stress[c] = vec3_dot(P[place[c][0]], at->F[place[c][1]]) / J;
}

/* dS = C dE */
static void stress_change(const fem_material *material, const fem_lame *lame, const double dE[3][3],
                          double dS[3][3]) {
  double trace = dE[0][0] + dE[1][1] + dE[2][2];
  if (material->anisotropic) {
    anisotropic_stress(material, dE, dS);
    return;
  }
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      dS[a][b] = 2 * lame->mu * dE[a][b] + (a == b ? lame->lambda * trace : 0);
}

void fem_cauchy_tangent(const fem_material *material, const fem_deformation *at, double D[6][9]) {
  static const int place[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  const fem_lame   lame        = fem_lame_of(material);
  const double(*F)[3] = at->F, J = determinant(at->F);
  double P[3][3], sigma[6], cofactor[3][3];
  multiply(F, at->S, P);
  fem_cauchy(at, sigma);
  for (int a = 0; a < 3; a++)
    for (int d = 0; d < 3; d++) {
      int a1 = (a + 1) % 3, a2 = (a + 2) % 3, d1 = (d + 1) % 3, d2 = (d + 2) % 3;
      cofactor[a][d] = F[a1][d1] * F[a2][d2] - F[a1][d2] * F[a2][d1];
    }
  for (int a = 0; a < 3; a++)
    for (int d = 0; d < 3; d++) { /* dF = e_a e_d^T */
      double dE[3][3], dS[3][3], Q[3][3];
      for (int p = 0; p < 3; p++)
        for (int q = 0; q < 3; q++) dE[p][q] = (F[a][p] * (q == d) + F[a][q] * (p == d)) / 2;
      stress_change(material, &lame, (const double(*)[3])dE, dS);
      multiply(F, (const double(*)[3])dS, Q);
      for (int c = 0; c < 6; c++) {
        int    i = place[c][0], j = place[c][1];
        double turned   = (i == a) * P[j][d] + (j == a) * P[i][d];
        D[c][3 * a + d] = (vec3_dot(Q[i], F[j]) + turned - cofactor[a][d] * sigma[c]) / J;
      }
    }
}

double fem_von_mises(const double stress[6]) {
  double square = 0;
  for (int a = 0; a < 3; a++) {
    double difference = stress[a] - stress[(a + 1) % 3];
    square += difference * difference / 2 + 3 * stress[3 + a] * stress[3 + a];
  }
  return sqrt(square);
}

double fem_element_stress(const fem_element *element, const fem_material *material,
                          const double x[][3], const double u[][3]) {
  const fem_rule *rule     = fem_element_stiffness_rule(element, x);
  double          greatest = 0;
  for (int p = 0; p < rule->n; p++) {
    fem_deformation at;
    double          g[MESH_NODES][3], H[3][3], stress[6];
    fem_element_gradient(element, rule, p, x, g);
    fem_displacement_gradient(element->n, (const double(*)[3])g, u, H);
    fem_deformation_at(material, (const double(*)[3])H, &at);
    fem_cauchy(&at, stress);
    greatest = fmax(greatest, fem_von_mises(stress));
  }
  return greatest;
}
