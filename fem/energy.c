#include "fem/energy.h"

#include <string.h>

/* lambda (tr e)^2 + 2 mu e : e of the displacement gradient H[a][d] = du_a / dx_d. */
static double density(double lambda, double mu, const double H[3][3]) {
  double trace = H[0][0] + H[1][1] + H[2][2], square = 0;
  for (int a = 0; a < 3; a++)
    for (int d = 0; d < 3; d++) {
      double strain = (H[a][d] + H[d][a]) / 2;
      square += strain * strain;
    }
  return lambda * trace * trace + 2 * mu * square;
}

static double element_energy(const fem_tet10 *element, double lambda, double mu,
                             const double x[10][3], const double u[10][3]) {
  const fem_tet_rule *rule = fem_tet10_stiffness_rule(element, x);
  double              sum  = 0;
  for (int p = 0; p < rule->n; p++) {
    double g[10][3], H[3][3] = {{0}};
    double volume = rule->weight[p] * fem_tet10_gradient(rule, p, x, g);
    for (int i = 1; i < 10; i++) /* from node 0: a translation leaves no trace */
      for (int a = 0; a < 3; a++)
        for (int d = 0; d < 3; d++) H[a][d] += (u[i][a] - u[0][a]) * g[i][d];
    sum += volume * density(lambda, mu, (const double(*)[3])H);
  }
  return sum;
}

double fem_strain_energy(const mesh_fe *mesh, const fem_material *material,
                         const fem_tet10 *element, const double *u) {
  double mu = material->E / (2 * (1 + material->nu)), sum = 0;
  double lambda = 2 * mu * material->nu / (1 - 2 * material->nu);
  for (int e = 0; e < mesh->n_elements; e++) {
    double at[10][3], by[10][3];
    for (int i = 0; i < 10; i++) {
      size_t node = 3 * (size_t)mesh->connectivity[10 * (size_t)e + (size_t)i];
      memcpy(at[i], mesh->coordinates + node, sizeof at[i]);
      memcpy(by[i], u + node, sizeof by[i]);
    }
    sum += element_energy(element, lambda, mu, (const double(*)[3])at, (const double(*)[3])by);
  }
  return sum;
}
