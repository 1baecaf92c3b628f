/* The rotating body: load, tangent, equilibrium, against closed forms and differences. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/body/equilibrium.h"
#include "fem/body/tangent.h"
#include "fem/solver/petsc_error.h"
#include "tests/support/box.h"
#include "tests/support/fem.h"

static fem_element *element;

static double wave(int i, int d, double phase) {
  return sin(2.3 * i + 1.7 * d * d + phase);
}

static double *field(const mesh_fe *mesh, double amount, double phase) {
  double *u = calloc(3 * (size_t)mesh->n_nodes, sizeof *u);
  assert_non_null(u);
  for (int i = 0; i < mesh->n_nodes; i++)
    for (int d = 0; d < 3; d++) u[3 * i + d] = amount * wave(i, d, phase);
  for (int i = 0; i < mesh_topology_of(mesh->kind)->face_nodes * mesh->set[MESH_ROOT].n; i++)
    memset(u + 3 * mesh->set[MESH_ROOT].nodes[i], 0, 3 * sizeof *u);
  return u;
}

/* The sum of forces is Omega^2 rho times the integral of r dV about each axis, also on a body that
 * has moved. */
static void load_adds_up_to_the_centrifugal_force(void **state) {
  (void)state;
  const double size[3] = {.21, .13, .08}, moved[3] = {.031, -.052, .017}, speed = 371;
  const int    cells[3] = {3, 2, 2};
  const double mass     = steel.rho * size[0] * size[1] * size[2];
  mesh_fe      mesh     = make_box(size, cells);
  mesh.set[MESH_ROOT].n = 0;
  shake_inside(&mesh, size, .004); /* curved elements inside */
  double *u = field(&mesh, 0, 0);
  for (int i = 0; i < 3 * mesh.n_nodes; i++) u[i] = moved[i % 3];
  for (int axis = 0; axis < MESH_AXIS_MZ + 1; axis++) {
    const fem_body     body = {&mesh, &steel, element, {(mesh_axis)axis, speed}, 0};
    fem_system         system;
    Vec                R;
    double             sum[3] = {0};
    const PetscScalar *value;
    assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
    assert_int_equal(MatCreateVecs(system.K, NULL, &R), 0);
    assert_int_equal(fem_residual_assemble(&body, &system, u, R), 0);
    assert_int_equal(VecGetArrayRead(R, &value), 0);
    for (int i = 0; i < 3 * mesh.n_nodes; i++) sum[i % 3] -= value[i];
    assert_int_equal(VecRestoreArrayRead(R, &value), 0);
    for (int d = 0; d < 3; d++) {
      double force = d == axis % 3 ? 0 : mass * speed * speed * (size[d] / 2 + moved[d]);
      check_below(sum[d] - force, 1e-11 * mass * speed * speed * size[0], "resultant");
    }
    VecDestroy(&R);
    fem_system_destroy(&system);
  }
  free(u);
  mesh_fe_free(&mesh);
}

/* Central differences of R along a direction err by c h^2; d . K d is the energy from the
 * strains. */
static void tangent_is_the_derivative_of_the_residual(void **state) {
  (void)state;
  const double size[3]  = {.21, .13, .08};
  const int    cells[3] = {3, 2, 1};
  mesh_fe      mesh     = make_box(size, cells);
  shake_inside(&mesh, size, .004);
  const fem_body body = {&mesh, &steel, element, {MESH_AXIS_Y, 20000}, 0};
  const size_t   n    = 3 * (size_t)mesh.n_nodes;
  double      *u = field(&mesh, .004, .4), *d = field(&mesh, 1, 1.9), *shifted = field(&mesh, 0, 0);
  double       error[3], norm, energy;
  fem_system   system;
  Vec          direction, slope, R[2];
  PetscScalar *value;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
  assert_int_equal(MatCreateVecs(system.K, &direction, &slope), 0);
  for (int s = 0; s < 2; s++) assert_int_equal(VecDuplicate(slope, &R[s]), 0);
  assert_int_equal(VecGetArray(direction, &value), 0);
  for (size_t i = 0; i < n; i++)
    if (system.row[i / 3] >= 0) value[3 * system.row[i / 3] + (int)(i % 3)] = d[i];
  assert_int_equal(VecRestoreArray(direction, &value), 0);
  assert_int_equal(fem_tangent_assemble(&body, u, &system), 0);
  assert_int_equal(MatMult(system.K, direction, slope), 0);
  assert_int_equal(VecDot(direction, slope, &energy), 0);
  check_close(tangent_energy(&body, u, d), energy, 1e-11, "energy");
  assert_int_equal(VecNorm(slope, NORM_INFINITY, &norm), 0);
  for (int level = 0; level < 3; level++) {
    double h = .002 / (1 << level);
    for (int s = 0; s < 2; s++) {
      for (size_t i = 0; i < n; i++) shifted[i] = u[i] + (s ? h : -h) * d[i];
      assert_int_equal(fem_residual_assemble(&body, &system, shifted, R[s]), 0);
    }
    assert_int_equal(VecAXPY(R[1], -1, R[0]), 0);
    assert_int_equal(VecAYPX(R[1], 1 / (2 * h), slope), 0); /* R[1] = slope + R[1] / (2 h) */
    assert_int_equal(VecAXPY(R[1], -2, slope), 0);
    assert_int_equal(VecNorm(R[1], NORM_INFINITY, &error[level]), 0);
    error[level] /= norm;
  }
  assert_true(error[0] > 1e-5);
  check_close(error[0] / error[1], 4, 1e-6, "ratio of errors");
  check_close(error[1] / error[2], 4, 1e-6, "ratio of errors");
  for (int s = 0; s < 2; s++) VecDestroy(&R[s]);
  VecDestroy(&direction);
  VecDestroy(&slope);
  fem_system_destroy(&system);
  free(u), free(d), free(shifted);
  mesh_fe_free(&mesh);
}

/* ------------------------------------------------------------------ a rod */

static const double rod_length = .2, rod_hub = .3;

/* u' of P = E (1 + u') (u' + u'^2/2), the first Piola-Kirchhoff stress of a rod with nu = 0. */
static double strain_of(double P) {
  double e = P / steel.E;
  for (int i = 0; i < 30; i++)
    e -= ((1 + e) * (e + e * e / 2) - P / steel.E) / (1 + 3 * e + 1.5 * e * e);
  return e;
}

/* Stress P at the tip from u' = strain(P), P' = -rho Omega^2 (hub + s + u) with P0 at the clamp, by
 * the classical Runge-Kutta rule. */
static double shoot(double P0, double speed, double *tip) {
  enum { STEPS = 400 };
  double u = 0, P = P0, h = rod_length / STEPS, c = steel.rho * speed * speed;
  for (int i = 0; i < STEPS; i++) {
    double s = rod_hub + i * h, du[4], dP[4];
    for (int k = 0; k < 4; k++) {
      double part = k == 0 ? 0 : k == 3 ? h : h / 2, from = k > 0 ? part : 0;
      du[k] = strain_of(P + (k ? from * dP[k - 1] : 0));
      dP[k] = -c * (s + part + u + (k ? from * du[k - 1] : 0));
    }
    u += h * (du[0] + 2 * du[1] + 2 * du[2] + du[3]) / 6;
    P += h * (dP[0] + 2 * dP[1] + 2 * dP[2] + dP[3]) / 6;
  }
  *tip = u;
  return P;
}

static double rod_tip(double speed) {
  double low = 0, high = 2 * steel.rho * speed * speed * rod_length * (rod_hub + rod_length), tip;
  for (int i = 0; i < 100; i++) {
    double middle                                    = (low + high) / 2;
    *(shoot(middle, speed, &tip) < 0 ? &low : &high) = middle;
  }
  return tip;
}

static mesh_fe make_rod(double from, int n) {
  const double size[3]  = {rod_length, .004, .004};
  const int    cells[3] = {n, used_elements() == MESH_HEX20 ? 2 : 1, 1};
  mesh_fe      mesh     = make_box(size, cells);
  for (int i = 0; i < mesh.n_nodes; i++) {
    mesh.coordinates[3 * i] += from;
    mesh.coordinates[3 * i + 1] -= .002;
    mesh.coordinates[3 * i + 2] -= .002;
  }
  return mesh;
}

/* A rod without lateral contraction stretches by its differential equation, 5 % at the clamp. */
static void rod_stretches_as_its_equation_says(void **state) {
  (void)state;
  const fem_material material = {.E = steel.E, .rho = steel.rho};
  const double       speed = 4200, at_tip[3] = {rod_hub + rod_length, 0, 0};
  mesh_fe            mesh = make_rod(rod_hub, 24);
  const fem_body     body = {&mesh, &material, element, {MESH_AXIS_MZ, speed}, 0};
  fem_system         system;
  fem_equilibrium    at;
  Vec                R;
  double             out_of_balance, load, *rest = field(&mesh, 0, 0);
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &material, FEM_STANDARD, &system), 0);
  assert_int_equal(fem_equilibrium_solve(&body, &system, NULL, &at), 0);
  double tip = at.displacement[3 * mesh_fe_nearest(&mesh, at_tip)], wanted = rod_tip(speed);
  print_message(
      "tip of the rod: %.9g m, its equation %.9g m, off by %.1e; %d iterations, %d "
      "factors\n",
      tip, wanted, fabs(tip / wanted - 1), at.iterations, at.factorisations);
  check_close(tip, wanted, 1e-5, "tip of the rod");
  assert_int_equal(MatCreateVecs(system.K, NULL, &R), 0);
  assert_int_equal(fem_residual_assemble(&body, &system, at.displacement, R), 0);
  assert_int_equal(VecNorm(R, NORM_2, &out_of_balance), 0);
  assert_int_equal(fem_residual_assemble(&body, &system, rest, R), 0);
  assert_int_equal(VecNorm(R, NORM_2, &load), 0);
  check_below(out_of_balance, 1e-9 * load, "out of balance");
  VecDestroy(&R);
  fem_equilibrium_free(&at);
  fem_system_destroy(&system);
  free(rest);
  mesh_fe_free(&mesh);
}

/* Clamped at its outer end the rod is compressed; beyond its strength there is no equilibrium. */
static void no_equilibrium_is_told(void **state) {
  (void)state;
  const double    speed = 6e4;
  mesh_fe         mesh  = make_rod(-rod_hub - rod_length, 8);
  const fem_body  body  = {&mesh, &steel, element, {MESH_AXIS_Z, speed}, 0};
  fem_system      system;
  fem_equilibrium at;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
  PetscPushErrorHandler(fem_petsc_error_handler, NULL);
  assert_int_equal(fem_petsc_status(fem_equilibrium_solve(&body, &system, NULL, &at)),
                   SHB_ERR_INPUT);
  PetscPopErrorHandler();
  print_message("%s\n", shb_message());
  assert_non_null(strstr(shb_message(), "rotor.speed: no static equilibrium at 60000 rad/s"));
  assert_non_null(strstr(shb_message(), "load step"));
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
      cmocka_unit_test(load_adds_up_to_the_centrifugal_force),
      cmocka_unit_test(tangent_is_the_derivative_of_the_residual),
      cmocka_unit_test(rod_stretches_as_its_equation_says),
      cmocka_unit_test(no_equilibrium_is_told),
  };
  if (PetscInitialize(NULL, NULL, NULL, NULL) != 0) return 1;
  int failures = run_with_both_elements(tests, tables, free_tables);
  PetscFinalize();
  return failures;
}
