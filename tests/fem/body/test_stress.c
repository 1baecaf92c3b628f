/* Nodal stresses and clamp forces. */
#include "fem/body/stress.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "fem/body/equilibrium.h"
#include "fem/element/finite_strain.h"
#include "tests/support/fem.h"

static const double size[3] = {.21, .13, .08};
static fem_element *element;

typedef void (*motion)(const double x[3], double u[3]);

/* Largest difference from the stress wanted, relative to its largest value. */
static double stress_error(const int cells[3], double shake, const fem_material *material,
                           motion move, motion normal, motion shear) {
  mesh_fe mesh = make_box(size, cells);
  shake_inside(&mesh, size, shake);
  const fem_body body = {&mesh, material, element, {MESH_AXIS_X, 0}, 0};
  double        *u = calloc(3 * (size_t)mesh.n_nodes, sizeof *u), error = 0, most = 0;
  double(*stress)[FEM_STRESSES] = calloc((size_t)mesh.n_nodes, sizeof *stress);
  for (int i = 0; i < mesh.n_nodes; i++) move(mesh.coordinates + 3 * i, u + 3 * i);
  fem_nodal_stress(&body, u, stress);
  for (int i = 0; i < mesh.n_nodes; i++) {
    double wanted[6];
    normal(mesh.coordinates + 3 * i, wanted);
    shear(mesh.coordinates + 3 * i, wanted + 3);
    for (int c = 0; c < 6; c++) {
      error = fmax(error, fabs(stress[i][c] - wanted[c]));
      most  = fmax(most, fabs(wanted[c]));
    }
  }
  free(u), free(stress);
  mesh_fe_free(&mesh);
  return error / most;
}

static void nothing(const double x[3], double s[3]) {
  (void)x;
  s[0] = s[1] = s[2] = 0;
}

/* Stretched by 1.1, 0.95, 1.02 and rotated by 90 degrees about z. */
static void stretch(const double x[3], double u[3]) {
  u[0] = -.95 * x[1] - x[0];
  u[1] = 1.1 * x[0] - x[1];
  u[2] = .02 * x[2];
}

/* sigma_i = l_i^2 S_i / (l_1 l_2 l_3); after the rotation x and y change places. */
static void stretched(const double x[3], double s[3]) {
  const double   l[3] = {1.1, .95, 1.02}, volume = l[0] * l[1] * l[2];
  const fem_lame c = fem_lame_of(&steel);
  double         E[3], sigma[3], trace = 0;
  (void)x;
  for (int d = 0; d < 3; d++) trace += E[d] = (l[d] * l[d] - 1) / 2;
  for (int d = 0; d < 3; d++)
    sigma[d] = l[d] * l[d] * (c.lambda * trace + 2 * c.mu * E[d]) / volume;
  s[0] = sigma[1], s[1] = sigma[0], s[2] = sigma[2];
}

static void constant_stress_is_exact(void **state) {
  (void)state;
  const int cells[3] = {3, 2, 2};
  check_below(stress_error(cells, .004, &steel, stretch, stretched, nothing), 1e-12, "stretch");
}

static const fem_material cork = {.E = 2.1e11, .rho = 7850};
static const double       bend = 1e-9;

/* Pure bending in the plane x, z. */
static void bending(const double x[3], double u[3]) {
  u[0] = bend * x[0] * x[2];
  u[1] = 0;
  u[2] = -bend * x[0] * x[0] / 2;
}

static void bent(const double x[3], double s[3]) {
  s[0] = cork.E * bend * x[2];
  s[1] = s[2] = 0;
}

/* At every node, corners and edges of the box included. */
static void linear_stress_is_exact(void **state) {
  (void)state;
  const int cells[3] = {3, 2, 2};
  check_below(stress_error(cells, 0, &cork, bending, bent, nothing), 1e-8, "bending");
}

static void wave(const double x[3], double u[3]) {
  u[0] = bend * sin(14 * x[1]);
  u[1] = u[2] = 0;
}

static void waved(const double x[3], double s[3]) { /* xy, yz, xz */
  s[0] = cork.E / 2 * bend * 14 * cos(14 * x[1]);
  s[1] = s[2] = 0;
}

static void error_is_of_second_order(void **state) {
  (void)state;
  const int cells[3] = {2, 3, 1}, finer[3] = {4, 6, 2}, finest[3] = {8, 12, 4};
  double    error[3] = {stress_error(cells, 0, &cork, wave, nothing, waved),
                        stress_error(finer, 0, &cork, wave, nothing, waved),
                        stress_error(finest, 0, &cork, wave, nothing, waved)};
  print_message("stress at the nodes, errors %.1e %.1e %.1e\n", error[0], error[1], error[2]);
  for (int i = 0; i < 2; i++) assert_true(error[i] / error[i + 1] > 3.4);
}

/* Stretched by 1.1, 0.95, 1.02, rotated, and bent a little. */
static void large(const double x[3], double u[3]) {
  stretch(x, u);
  u[0] += 0.4 * x[1] * x[2];
  u[2] += 0.3 * x[0] * x[0];
}

static void small(const double x[3], double u[3]) {
  u[0] = 0.2 * x[1] - 0.7 * x[0] * x[2];
  u[1] = 0.9 * x[1] * x[2] + 0.1 * x[0];
  u[2] = 0.5 * x[0] - 0.4 * x[2] + 0.6 * x[1] * x[1];
}

/* Differences of the stresses of two states; nine motions need two groups of lanes. */
static void check_change(const mesh_fe *mesh, const fem_material *material) {
  enum { MOTIONS = 9 };
  const fem_body body = {mesh, material, element, {MESH_AXIS_X, 0}, 0};
  const size_t   n    = (size_t)mesh->n_nodes;
  const double   step = 1e-6;
  double        *u = malloc(3 * n * sizeof *u), *shifted = malloc(3 * n * sizeof *u);
  double        *moves = malloc(3 * n * MOTIONS * sizeof *u), error = 0, most = 0;
  float         *change = malloc(6 * n * MOTIONS * sizeof *change);
  double(*stress[2])[FEM_STRESSES];
  for (int s = 0; s < 2; s++) stress[s] = malloc(n * sizeof *stress[s]);
  for (size_t i = 0; i < n; i++) {
    large(mesh->coordinates + 3 * i, u + 3 * i);
    for (size_t k = 0; k < MOTIONS; k++) {
      double *v = moves + 3 * (k * n + i);
      small(mesh->coordinates + 3 * i, v);
      for (int d = 0; d < 3; d++) v[d] *= (double)k - 3.5;
    }
  }
  fem_nodal_stress_change(&body, u, MOTIONS, moves, change);
  for (size_t k = 0; k < MOTIONS; k += MOTIONS - 1) {
    for (int s = 0; s < 2; s++) {
      for (size_t i = 0; i < 3 * n; i++)
        shifted[i] = u[i] + (s ? step : -step) * moves[3 * k * n + i];
      fem_nodal_stress(&body, shifted, stress[s]);
    }
    const double *before = (const double *)stress[0], *after = (const double *)stress[1];
    for (size_t i = 0; i < 6 * n; i++) {
      double wanted = (after[i] - before[i]) / (2 * step);
      error         = fmax(error, fabs(change[6 * k * n + i] - wanted));
      most          = fmax(most, fabs(wanted));
    }
  }
  check_below(error, 1e-6 * most, "change of stress");
  for (int s = 0; s < 2; s++) free(stress[s]);
  free(u), free(shifted), free(moves), free(change);
}

static void change_is_the_derivative(void **state) {
  (void)state;
  const fem_orthotropic crystal = {
      {127e9, 141e9, 118e9}, {.38, .31, .27}, {120e9, 97e9, 71e9}, {.3, -.8, .52}, {.9, .2, -.4}};
  const int    cells[3] = {3, 2, 2};
  fem_material material;
  mesh_fe      mesh = make_box(size, cells);
  shake_inside(&mesh, size, .004);
  check_change(&mesh, &steel);
  assert_int_equal(fem_material_orthotropic(&crystal, 8500, &material), SHB_OK);
  check_change(&mesh, &material);
  mesh_fe_free(&mesh);
}

/* Equal strain in two materials: the nodes between them have the stress of the stiffer one. */
static void stiffest_material_counts(void **state) {
  (void)state;
  const fem_material   parts[2] = {{.E = 0.7e11, .rho = 1}, {.E = 2.1e11, .rho = 1}};
  const int            cells[3] = {2, 1, 1};
  mesh_fe              mesh     = make_box(size, cells);
  const mesh_topology *topology = mesh_topology_of(mesh.kind);
  const size_t         n        = (size_t)mesh.n_nodes;
  const double         strain   = 1e-7;
  double              *u        = calloc(3 * n, sizeof *u);
  float               *change   = calloc(6 * n, sizeof *change);
  double(*stress)[FEM_STRESSES] = calloc(n, sizeof *stress);
  int between                   = 0;
  mesh.n_regions                = 2;
  mesh.region                   = malloc((size_t)mesh.n_elements * sizeof(int));
  for (int e = 0; e < mesh.n_elements; e++) {
    double x = 0;
    for (int i = 0; i < topology->corners; i++)
      x += mesh.coordinates[3 * mesh.connectivity[topology->nodes * e + i]] / topology->corners;
    mesh.region[e] = x > size[0] / 2;
  }
  const fem_body body = {&mesh, parts, element, {MESH_AXIS_X, 0}, 0};
  for (size_t i = 0; i < n; i++) u[3 * i] = strain * mesh.coordinates[3 * i];
  fem_nodal_stress(&body, u, stress);
  fem_nodal_stress_change(&body, NULL, 1, u, change);
  for (size_t i = 0; i < n; i++) {
    double x = mesh.coordinates[3 * i], E = parts[x > size[0] / 2 - 1e-9].E;
    check_close(stress[i][0], E * strain, 1e-6, "stress");
    check_close(change[6 * i], E * strain, 1e-6, "change of stress");
    between += fabs(x - size[0] / 2) < 1e-9;
  }
  assert_true(between >= 8);
  free(u), free(change), free(stress);
  mesh_fe_free(&mesh);
}

/* The clamp bears the centrifugal force of the deformed body, including its moment about the
 * axis. */
static void reactions_add_up_to_the_load(void **state) {
  (void)state;
  const int       cells[3] = {3, 2, 2};
  mesh_fe         mesh     = make_box(size, cells);
  const fem_body  body     = {&mesh, &steel, element, {MESH_AXIS_Z, 4000}, 0};
  fem_system      system;
  fem_equilibrium at;
  double          load[3], sum[3] = {0}, turn = 0, most = 0;
  double(*force)[3] = calloc((size_t)mesh.n_nodes, sizeof *force);
  shake_inside(&mesh, size, .004);
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
  assert_int_equal(fem_equilibrium_solve(&body, &system, NULL, &at), 0);
  assert_int_equal(fem_unbalanced_forces(&body, at.displacement, force, load), 0);
  for (int i = 0; i < mesh.n_nodes; i++) {
    const double *x = mesh.coordinates + 3 * i;
    for (int d = 0; d < 3; d++) {
      if (system.row[i] < 0)
        sum[d] += force[i][d];
      else
        most = fmax(most, fabs(force[i][d]));
    }
    if (system.row[i] < 0) turn += x[0] * force[i][1] - x[1] * force[i][0];
  }
  check_below(most, 1e-9 * fabs(load[0]), "out of balance at free nodes");
  for (int d = 0; d < 3; d++)
    check_below(sum[d] + load[d], 1e-9 * fabs(load[0]), "reaction and load");
  check_below(turn, 1e-9 * fabs(load[0]) * size[0], "moment about the engine axis");
  /* mass times Omega^2 times the distance of the centre; larger for a stretched body */
  double mass = steel.rho * size[0] * size[1] * size[2], rest = mass * 4000. * 4000 * size[0] / 2;
  assert_true(load[0] > rest && load[0] < 1.01 * rest);
  check_below(load[2], 1e-12 * load[0], "load along the axis");
  print_message("load %.10g N (at rest %.10g), reaction off by %.1e\n", load[0], rest,
                fabs(sum[0] + load[0]) / load[0]);
  free(force);
  fem_equilibrium_free(&at);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

static int tables(void **state) {
  (void)state;
  element = make_element_tables(FEM_STANDARD);
  return element == NULL;
}

static int free_tables(void **state) {
  (void)state;
  free(element);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(constant_stress_is_exact), cmocka_unit_test(linear_stress_is_exact),
      cmocka_unit_test(error_is_of_second_order), cmocka_unit_test(change_is_the_derivative),
      cmocka_unit_test(stiffest_material_counts), cmocka_unit_test(reactions_add_up_to_the_load)};
  if (PetscInitialize(NULL, NULL, NULL, NULL)) return 1;
  int failures = run_with_both_elements(tests, tables, free_tables);
  PetscFinalize();
  return failures;
}
