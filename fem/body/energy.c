#include "fem/body/energy.h"

#include <string.h>

#include "fem/body/pressure.h"
#include "fem/element/finite_strain.h"

/* e C e with shear strains doubled. */
static double anisotropic(const double C[6][6], const double pulled[3][3]) {
  const double e[6] = {pulled[0][0],
                       pulled[1][1],
                       pulled[2][2],
                       pulled[0][1] + pulled[1][0],
                       pulled[0][2] + pulled[2][0],
                       pulled[1][2] + pulled[2][1]};
  double       sum  = 0;
  for (int p = 0; p < 6; p++)
    for (int q = 0; q < 6; q++) sum += e[p] * C[p][q] * e[q];
  return sum;
}

/* lambda (tr e)^2 + 2 mu e : e, or e C e if anisotropic; e = sym(F^T H). */
static double elastic(const fem_material *material, const double F[3][3], const double H[3][3]) {
  const fem_lame lame = fem_lame_of(material);
  double         pulled[3][3], trace = 0, square = 0;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      pulled[a][b] = F[0][a] * H[0][b] + F[1][a] * H[1][b] + F[2][a] * H[2][b];
  if (material->anisotropic) return anisotropic(material->C, (const double(*)[3])pulled);
  for (int a = 0; a < 3; a++) {
    trace += pulled[a][a];
    for (int b = 0; b < 3; b++) {
      double strain = (pulled[a][b] + pulled[b][a]) / 2;
      square += strain * strain;
    }
  }
  return lame.lambda * trace * trace + 2 * lame.mu * square;
}

/* H S : H */
static double geometric(const double S[3][3], const double H[3][3]) {
  double sum = 0;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      for (int c = 0; c < 3; c++) sum += H[a][b] * S[b][c] * H[a][c];
  return sum;
}

/* Deformation of the state at a point. */
typedef struct {
  bool            rest;
  fem_deformation at;
} point_state;

static double density(const fem_material *material, const point_state *state_here,
                      const double h[3][3]) {
  static const double identity[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (state_here->rest) return elastic(material, identity, h);
  return elastic(material, (const double(*)[3])state_here->at.F, h) +
         geometric((const double(*)[3])state_here->at.S, h);
}

/* Add the stored energy of an element for n fields.
 *   state   in      [nodes][3], NULL at rest
 *   u       in      [n][nodes][3]
 *   energy  in/out  [n] */
static void add_stored(const fem_element *element, const fem_material *material,
                       const double x[][3], const double state[][3], int n,
                       const double u[][MESH_NODES][3], double *energy) {
  const fem_rule *rule = fem_element_stiffness_rule(element, x);
  for (int p = 0; p < rule->n; p++) {
    point_state state_here = {.rest = !state};
    double      g[MESH_NODES][3], h[3][3];
    double      volume = rule->weight[p] * fem_element_gradient(element, rule, p, x, g);
    if (state) {
      fem_displacement_gradient(element->n, (const double(*)[3])g, state, h);
      fem_deformation_at(material, (const double(*)[3])h, &state_here.at);
    }
    for (int i = 0; i < n; i++) {
      fem_displacement_gradient(element->n, (const double(*)[3])g, u[i], h);
      energy[i] += volume * density(material, &state_here, (const double(*)[3])h);
    }
  }
}

static double centrifugal(const fem_body *body, double rho, const double x[][3],
                          const double u[][3]) {
  const int n = body->element->n;
  double    m[MESH_NODES * MESH_NODES], square[3], sum = 0;
  fem_rotation_square(&body->rotation, square);
  fem_element_mass(body->element, rho, x, m);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      for (int d = 0; d < 3; d++) sum += m[n * i + j] * square[d] * u[i][d] * u[j][d];
  return sum;
}

/* Energies of the elements begin .. end - 1.
 *   u       in   [n <= FEM_FIELDS][n_nodes][3]
 *   energy  out  [n] */
static void sum_elements(const fem_body *body, const double *state, int begin, int end, int n,
                         const double *u, double *energy) {
  const size_t stride = 3 * (size_t)body->mesh->n_nodes;
  memset(energy, 0, (size_t)n * sizeof *energy);
  for (int e = begin; e < end; e++) {
    double              x[MESH_NODES][3], at[MESH_NODES][3], by[FEM_FIELDS][MESH_NODES][3];
    const fem_material *own = fem_material_at(body->material, body->mesh, e);
    if (state) fem_body_element(body, e, state, x, at);
    for (int i = 0; i < n; i++) fem_body_element(body, e, u + (size_t)i * stride, x, by[i]);
    add_stored(body->element, own, (const double(*)[3])x, state ? (const double(*)[3])at : NULL, n,
               (const double(*)[MESH_NODES][3])by, energy);
    for (int i = 0; i < n && body->rotation.speed != 0; i++)
      energy[i] -= centrifugal(body, own->rho, (const double(*)[3])x, (const double(*)[3])by[i]);
  }
}

/* Parts of the elements are summed apart, on all threads, then together in their order. */
static void sum_parts(const fem_body *body, const double *state, int n, const double *u,
                      double *energy) {
  enum { PARTS = 64 };
  const int each = body->mesh->n_elements / PARTS + 1, all = body->mesh->n_elements;
  double    part[PARTS][FEM_FIELDS] = {{0}};
#pragma omp parallel for schedule(dynamic, 1)
  for (int k = 0; k < PARTS; k++) {
    const int begin = k * each, end = begin + each < all ? begin + each : all;
    if (begin < end) sum_elements(body, state, begin, end, n, u, part[k]);
  }
  memset(energy, 0, (size_t)n * sizeof *energy);
  for (int k = 0; k < PARTS; k++)
    for (int i = 0; i < n; i++) energy[i] += part[k][i];
}

void fem_tangent_energies(const fem_body *body, const double *state, int n, const double *u,
                          double *energy) {
  const size_t stride = 3 * (size_t)body->mesh->n_nodes;
  for (int first = 0; first < n; first += FEM_FIELDS) {
    const int count = n - first < FEM_FIELDS ? n - first : FEM_FIELDS;
    sum_parts(body, state, count, u + (size_t)first * stride, energy + first);
  }
  for (int i = 0; i < n; i++) energy[i] += fem_pressure_energy(body, state, u + (size_t)i * stride);
}
