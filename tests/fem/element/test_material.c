/* Anisotropic materials: closed forms of single crystals; energy, force and tangent of elements. */
#include "fem/element/material.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/element/finite_strain.h"
#include "tests/support/fem.h"

typedef const double (*fixed)[3];

/* A nickel superalloy's crystal at room temperature, approximately. */
static fem_orthotropic crystal(void) {
  return (fem_orthotropic){
      {127e9, 127e9, 127e9}, {.38, .38, .38}, {120e9, 120e9, 120e9}, {1, 0, 0}, {0, 1, 0}};
}

/* All constants differ. */
static fem_orthotropic odd_one(void) {
  return (fem_orthotropic){
      {90e9, 150e9, 210e9}, {.21, .17, .34}, {61e9, 47e9, 83e9}, {.3, -.8, .52}, {.9, .2, -.4}};
}

static fem_material made(const fem_orthotropic *from) {
  fem_material material;
  if (fem_material_orthotropic(from, 8500, &material) != SHB_OK) fail_msg("%s", shb_message());
  assert_true(material.rho == 8500 && material.anisotropic);
  return material;
}

/* x = C^-1 b by elimination; C is positive definite. */
static void solve(const double C[6][6], const double b[6], double x[6]) {
  double A[6][7];
  for (int i = 0; i < 6; i++) {
    memcpy(A[i], C[i], 6 * sizeof(double));
    A[i][6] = b[i];
  }
  for (int p = 0; p < 6; p++)
    for (int i = 0; i < 6; i++) {
      double factor = A[i][p] / A[p][p];
      for (int j = 6; j >= p && i != p; j--) A[i][j] -= factor * A[p][j];
    }
  for (int i = 0; i < 6; i++) x[i] = A[i][6] / A[i][i];
}

/* Strain along m under the unit stress n n^T. */
static double strain(const fem_material *material, const double n[3], const double m[3]) {
  const double stress[6] = {n[0] * n[0], n[1] * n[1], n[2] * n[2],
                            n[0] * n[1], n[0] * n[2], n[1] * n[2]};
  double       e[6];
  solve(material->C, stress, e);
  return e[0] * m[0] * m[0] + e[1] * m[1] * m[1] + e[2] * m[2] * m[2] + e[3] * m[0] * m[1] +
         e[4] * m[0] * m[2] + e[5] * m[1] * m[2];
}

/* 1/E(l, m, n) = S11 - 2 (S11 - S12 - S44/2)(l^2 m^2 + m^2 n^2 + n^2 l^2). */
static void cubic_moduli_follow_the_direction(void **state) {
  (void)state;
  const fem_orthotropic from       = crystal();
  const fem_material    material   = made(&from);
  const double          along[][3] = {{1, 0, 0},
                                      {0, 0, 1},
                                      {M_SQRT1_2, M_SQRT1_2, 0},
                                      {sqrt(1. / 3), -sqrt(1. / 3), sqrt(1. / 3)},
                                      {2. / 7, 3. / 7, -6. / 7}};
  const double          S11 = 1 / 127e9, S12 = -.38 / 127e9, S44 = 1 / 120e9;
  for (size_t i = 0; i < sizeof along / sizeof *along; i++) {
    const double *n = along[i];
    double        a = n[0] * n[0], b = n[1] * n[1], c = n[2] * n[2];
    check_close(strain(&material, n, n), S11 - 2 * (S11 - S12 - S44 / 2) * (a * b + b * c + c * a),
                1e-13, "1/E along a direction");
  }
}

/* In its own axes, however oriented, the material has the constants given. */
static void constants_come_back(void **state) {
  (void)state;
  const fem_orthotropic from     = odd_one();
  const fem_material    material = made(&from);
  double                axis[3][3], length = 0, dot = 0, across = 0;
  for (int d = 0; d < 3; d++) length += from.axis[d] * from.axis[d];
  for (int d = 0; d < 3; d++) axis[0][d] = from.axis[d] / sqrt(length);
  for (int d = 0; d < 3; d++) dot += axis[0][d] * from.in_plane[d];
  for (int d = 0; d < 3; d++) {
    axis[1][d] = from.in_plane[d] - dot * axis[0][d];
    across += axis[1][d] * axis[1][d];
  }
  for (int d = 0; d < 3; d++) axis[1][d] /= sqrt(across);
  for (int d = 0; d < 3; d++)
    axis[2][d] =
        axis[0][(d + 1) % 3] * axis[1][(d + 2) % 3] - axis[0][(d + 2) % 3] * axis[1][(d + 1) % 3];
  static const int pair[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  for (int i = 0; i < 3; i++) {
    int p = pair[i][0], q = pair[i][1];
    check_close(strain(&material, axis[i], axis[i]), 1 / from.E[i], 1e-12, "E");
    check_close(strain(&material, axis[p], axis[q]), -from.nu[i] / from.E[p], 1e-12, "nu");
    check_close(strain(&material, axis[q], axis[p]), -from.nu[i] / from.E[p], 1e-12, "reciprocity");
    double n[3], m[3]; /* at 45 degrees: 4/E45 = 1/Ep + 1/Eq - 2 nu/Ep + 1/G */
    for (int d = 0; d < 3; d++) n[d] = (axis[p][d] + axis[q][d]) * M_SQRT1_2;
    memcpy(m, n, sizeof m);
    check_close(4 * strain(&material, n, m),
                1 / from.E[p] + 1 / from.E[q] - 2 * from.nu[i] / from.E[p] + 1 / from.G[i], 1e-12,
                "G");
  }
}

static void isotropy_has_no_direction(void **state) {
  (void)state;
  double          G        = steel.E / (2 * (1 + steel.nu)), C[6][6];
  fem_orthotropic from     = {{steel.E, steel.E, steel.E},
                              {steel.nu, steel.nu, steel.nu},
                              {G, G, G},
                              {.3, -.8, .52},
                              {.9, .2, -.4}};
  fem_material    material = made(&from);
  isotropic_stiffness(&steel, C);
  for (int p = 0; p < 6; p++)
    for (int q = 0; q < 6; q++) check_below(material.C[p][q] - C[p][q], 1e-13 * steel.E, "C");
}

static void refused(const fem_orthotropic *from, const char *words) {
  fem_material material;
  assert_int_equal(fem_material_orthotropic(from, 8500, &material), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), words));
  assert_null(strchr(shb_message(), '\n'));
}

static void impossible_materials_are_refused(void **state) {
  (void)state;
  fem_orthotropic from = crystal();
  from.nu[0]           = 1.01;
  refused(&from, "no stable material");
  from      = crystal();
  from.G[1] = 0;
  refused(&from, "no stable material");
  from       = crystal();
  from.nu[0] = from.nu[1] = from.nu[2] = .5; /* incompressible */
  refused(&from, "no stable material");
  from             = crystal();
  from.in_plane[0] = -2, from.in_plane[1] = 0;
  refused(&from, "not along one line");
  from         = crystal();
  from.axis[0] = 0;
  refused(&from, "not along one line");
}

static double field(int i, int d, double phase) {
  return sin(2.3 * i + 1.7 * d * d + phase);
}

static void make(mesh_kind kind, fem_element *element, double x[][3]) {
  const mesh_topology *topology = mesh_topology_of(kind);
  assert_int_equal(fem_element_create(kind, FEM_STANDARD, element), 0);
  for (int i = 0; i < topology->nodes; i++)
    for (int d = 0; d < 3; d++) x[i][d] = topology->place[i][d] + .01 * field(i, d, .4);
}

/* The force is the derivative of the energy, and K(u) that of the force, to the order of central
 * differences. At rest u^T K u is twice the energy. */
static void energy_force_and_tangent_agree(void **state) {
  (void)state;
  const fem_orthotropic from     = odd_one();
  const fem_material    material = made(&from);
  fem_element          *element  = malloc(sizeof *element);
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    double x[MESH_NODES][3], u[MESH_NODES][3], f[2][MESH_NODES][3];
    double K[FEM_DOFS * FEM_DOFS], T[FEM_DOFS * FEM_DOFS], zero[MESH_NODES][3] = {{0}}, most = 0;
    assert_non_null(element);
    make((mesh_kind)kind, element, x);
    const int order = 3 * element->n;
    fem_element_stiffness(element, &material, (fixed)x, K);
    fem_element_tangent(element, &material, (fixed)x, (fixed)zero, T);
    for (int i = 0; i < order * order; i++) most = fmax(most, fabs(K[i]));
    for (int i = 0; i < order * order; i++) check_below(T[i] - K[i], 1e-14 * most, "at rest");
    for (int i = 0; i < element->n; i++)
      for (int d = 0; d < 3; d++) u[i][d] = .08 * field(i, d, 1.1);
    fem_element_tangent(element, &material, (fixed)x, (fixed)u, T);
    const double h = 1e-5;
    for (int column = 0; column < order; column += 7) {
      double *moved = &u[0][0] + column, at = *moved;
      for (int side = 0; side < 2; side++) {
        *moved = at + (side ? h : -h);
        fem_element_force(element, &material, (fixed)x, (fixed)u, f[side]);
      }
      *moved = at;
      for (int row = 0; row < order; row++) {
        double slope = ((&f[1][0][0])[row] - (&f[0][0][0])[row]) / (2 * h);
        check_below(slope - T[order * row + column], 1e-8 * most, "derivative of the force");
      }
    }
  }
  free(element);
}

static double uniform_energy(const mesh_fe *mesh, const fem_material *material,
                             const fem_element *element, const double e[6]) {
  double *u = malloc(3 * (size_t)mesh->n_nodes * sizeof *u);
  assert_non_null(u);
  for (int i = 0; i < mesh->n_nodes; i++) {
    const double *x = mesh->coordinates + 3 * i;
    u[3 * i]        = e[0] * x[0] + e[3] * x[1] + e[4] * x[2];
    u[3 * i + 1]    = e[1] * x[1] + e[5] * x[2];
    u[3 * i + 2]    = e[2] * x[2];
  }
  double energy = strain_energy(mesh, material, element, u);
  free(u);
  return energy;
}

/* A uniform strain stores V e C e: with all points on any mesh, with fewer on straight edges. */
static void uniform_strain_is_exact(void **state) {
  (void)state;
  const double          size[3]  = {.2, .3, .1};
  const int             cells[3] = {2, 2, 1};
  const fem_orthotropic from     = odd_one();
  const fem_material    material = made(&from);
  const double          e[6]     = {3e-4, -1e-4, 2e-4, 4e-4, -5e-4, 1.5e-4};
  double                wanted   = 0;
  fem_element          *element  = malloc(sizeof *element);
  for (int p = 0; p < 6; p++)
    for (int q = 0; q < 6; q++) wanted += .006 * e[p] * material.C[p][q] * e[q];
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    use_elements((mesh_kind)kind);
    mesh_fe mesh = make_box(size, cells);
    assert_non_null(element);
    shake_inside(&mesh, size, .01);
    assert_int_equal(fem_element_create((mesh_kind)kind, FEM_FULL, element), 0);
    check_close(uniform_energy(&mesh, &material, element, e), wanted, 1e-12, "energy");
    straighten(&mesh);
    assert_int_equal(fem_element_create((mesh_kind)kind, FEM_STANDARD, element), 0);
    check_close(uniform_energy(&mesh, &material, element, e), wanted, 1e-12, "energy");
    mesh_fe_free(&mesh);
  }
  free(element);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cubic_moduli_follow_the_direction),
      cmocka_unit_test(constants_come_back),
      cmocka_unit_test(isotropy_has_no_direction),
      cmocka_unit_test(impossible_materials_are_refused),
      cmocka_unit_test(energy_force_and_tangent_agree),
      cmocka_unit_test(uniform_strain_is_exact),
  };
  if (PetscInitialize(NULL, NULL, NULL, NULL)) return 1;
  int failures = cmocka_run_group_tests_name("fem.material", tests, NULL, NULL);
  PetscFinalize();
  return failures;
}
