/* Bodies of two materials: energies and longitudinal modes in closed form, at rest and turning. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/body/equilibrium.h"
#include "modal/eigen/eigen.h"
#include "tests/support/fem.h"

enum { MODES = 8 };

/* No lateral contraction: motion along the bar alone solves the equations of the solid. */
static const fem_material parts[2] = {{.E = 2.1e11, .rho = 7850}, {.E = 0.7e11, .rho = 4430}};
/* first part, relative to the length */
static const double size[3] = {0.31, 0.1, 0.12}, share = 0.4;

/* 5 n cells along the bar, so that the interface lies between cells. */
static mesh_fe make_bar(int n) {
  mesh_fe              mesh     = make_box(size, (const int[]){5 * n, 1, 1});
  const mesh_topology *topology = mesh_topology_of(mesh.kind);
  mesh.n_regions                = 2;
  mesh.region                   = malloc((size_t)mesh.n_elements * sizeof(int));
  assert_non_null(mesh.region);
  for (int e = 0; e < mesh.n_elements; e++) {
    double x = 0;
    for (int i = 0; i < topology->corners; i++)
      x += mesh.coordinates[3 * mesh.connectivity[topology->nodes * e + i]] / topology->corners;
    mesh.region[e] = x > share * size[0];
  }
  return mesh;
}

/* E1 k1 cot(k1 a) = E2 k2 tan(k2 b) with equal wave speeds: waves from the clamp and from the free
 * end meet at the interface. */
static double mismatch(double omega) {
  double k[2], a = share * size[0], b = size[0] - a;
  for (int i = 0; i < 2; i++) k[i] = omega * sqrt(parts[i].rho / parts[i].E);
  return parts[0].E * k[0] * cos(k[0] * a) * cos(k[1] * b) -
         parts[1].E * k[1] * sin(k[1] * b) * sin(k[0] * a);
}

static double first_frequency(void) {
  double low = 1, high = 2;
  while (mismatch(high) > 0) high *= 1.1;
  for (int i = 0; i < 200; i++) {
    double mid                          = (low + high) / 2;
    *(mismatch(mid) > 0 ? &low : &high) = mid;
  }
  return low;
}

/* Relative error of the nearest eigenvalue. */
static double mode_error(int n, double omega) {
  mesh_fe              mesh   = make_bar(n);
  modal_eigen_settings wanted = {.modes = MODES, .tolerance = 1e-12};
  fem_system           system;
  modal_eigen          eigen = {0};
  double               least = INFINITY;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, parts, FEM_FULL, &system), 0);
  assert_int_equal(modal_eigen_solve(&system, &wanted, &eigen), 0);
  for (int i = 0; i < MODES; i++) least = fmin(least, fabs(eigen.lambda[i] / (omega * omega) - 1));
  modal_eigen_destroy(&eigen);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
  return least;
}

static void longitudinal_mode(mesh_kind kind) {
  double omega = first_frequency();
  use_elements(kind);
  double coarse = mode_error(1, omega), fine = mode_error(2, omega);
  print_message("%s: eigenvalue off by %.2e, with half the size %.2e (1/%.1f)\n",
                mesh_topology_of(kind)->name, coarse, fine, coarse / fine);
  check_below(coarse, 1e-3, "eigenvalue");
  assert_true(coarse > 11 * fine); /* fourth order */
}

static void modes_of_tetrahedra(void **state) {
  (void)state;
  longitudinal_mode(MESH_TET10);
}

static void modes_of_hexahedra(void **state) {
  (void)state;
  longitudinal_mode(MESH_HEX20);
}

/* u^T K u of a stretch, linear in each part, and Omega^2 u^T M u of a translation across the
 * axis. */
static void energies(void **state) {
  (void)state;
  const double strain[2] = {2.3e-4, -1.1e-4}, a = share * size[0], area = size[1] * size[2];
  const double speed = 731;
  for (int k = 0; k < 2; k++) {
    use_elements(k ? MESH_HEX20 : MESH_TET10);
    mesh_fe      mesh    = make_bar(1);
    fem_element *element = malloc(sizeof *element);
    double      *u       = calloc(3 * (size_t)mesh.n_nodes, sizeof *u);
    assert_true(element && u);
    assert_int_equal(fem_element_create(mesh.kind, FEM_STANDARD, element), 0);
    for (int i = 0; i < mesh.n_nodes; i++) {
      double x = mesh.coordinates[3 * i];
      u[3 * i] = strain[0] * fmin(x, a) + strain[1] * fmax(x - a, 0);
    }
    double wanted = area * (parts[0].E * strain[0] * strain[0] * a +
                            parts[1].E * strain[1] * strain[1] * (size[0] - a));
    check_close(strain_energy(&mesh, parts, element, u), wanted, 1e-12, "strain energy");
    for (int i = 0; i < 3 * mesh.n_nodes; i++) u[i] = i % 3 == 1 ? 1e-3 : 0;
    fem_body body = {&mesh, parts, element, {MESH_AXIS_X, speed}, 0};
    double   mass = area * (parts[0].rho * a + parts[1].rho * (size[0] - a));
    check_close(tangent_energy(&body, NULL, u), -1e-6 * speed * speed * mass, 1e-12, "softening");
    free(u);
    free(element);
    mesh_fe_free(&mesh);
  }
}

/* At slow rotation about z the tip displacement is u = Omega^2 int (1/E) int rho x. The inner
 * integral is over the outer part of the bar. */
static void stretch_under_rotation(void **state) {
  (void)state;
  const double    speed = 40, a = share * size[0], L = size[0];
  mesh_fe         mesh;
  fem_system      system;
  fem_equilibrium at;
  fem_element    *element = malloc(sizeof *element);
  use_elements(MESH_HEX20);
  mesh = make_bar(2);
  for (int i = 0; i < mesh.n_nodes; i++)
    for (int d = 1; d < 3; d++) mesh.coordinates[3 * i + d] -= size[d] / 2;
  assert_non_null(element);
  assert_int_equal(fem_element_create(mesh.kind, FEM_FULL, element), 0);
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, parts, FEM_FULL, &system), 0);
  fem_body body = {&mesh, parts, element, {MESH_AXIS_Z, speed}, 0};
  assert_int_equal(fem_equilibrium_solve(&body, &system, NULL, &at), 0);
  double outer = parts[1].rho * (L * L - a * a) / 2, inner = parts[0].rho;
  double tip = (outer * a + inner * (a * a * a - a * a * a / 3) / 2) / parts[0].E +
               parts[1].rho * (L * L * (L - a) - (L * L * L - a * a * a) / 3) / 2 / parts[1].E;
  double mean = 0;
  int    n    = 0;
  for (int i = 0; i < mesh.n_nodes; i++) {
    if (mesh.coordinates[3 * i] < L - 1e-9) continue;
    mean += at.displacement[3 * i];
    n++;
  }
  check_close(mean / n, speed * speed * tip, 1e-5, "stretch at the tip");
  fem_equilibrium_free(&at);
  fem_system_destroy(&system);
  free(element);
  mesh_fe_free(&mesh);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(modes_of_tetrahedra), cmocka_unit_test(modes_of_hexahedra),
      cmocka_unit_test(energies), cmocka_unit_test(stretch_under_rotation)};
  if (SlepcInitialize(&argc, &argv, NULL, NULL)) return 1;
  int failures = cmocka_run_group_tests_name("modal.materials", tests, NULL, NULL);
  SlepcFinalize();
  return failures;
}
