/* Participation factors and effective masses against closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <petscksp.h>

#include "mesh/base/constants.h"
#include "modal/common/session.h"
#include "modal/eigen/participation.h"
#include "tests/support/fem.h"

typedef struct {
  fem_element         element;
  fem_body            body;
  fem_system          system;
  modal_eigen         eigen;
  modal_participation share;
} model;

static model *make(const mesh_fe *mesh, const fem_material *material, int modes) {
  modal_eigen_settings settings = {.modes = modes};
  model               *m        = calloc(1, sizeof *m);
  assert_non_null(m);
  assert_int_equal(fem_element_create(mesh->kind, FEM_FULL, &m->element), 0);
  m->body = (fem_body){mesh, material, &m->element, {MESH_AXIS_X, 0}, 0};
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, mesh, material, FEM_FULL, &m->system), 0);
  if (modes <= 0) settings.modes = 3 * (int)m->system.n_free;
  if (modal_eigen_solve(&m->system, &settings, &m->eigen) != 0) fail_msg("%s", shb_message());
  assert_int_equal(modal_participation_create(&m->body, NULL, &m->system, &m->eigen, &m->share),
                   SHB_OK);
  return m;
}

static void release(model *m) {
  modal_participation_free(&m->share);
  assert_int_equal(modal_eigen_destroy(&m->eigen), 0);
  assert_int_equal(fem_system_destroy(&m->system), 0);
  free(m);
}

static double effective(const model *m, int mode, int r) {
  double gamma = m->share.gamma[FEM_RIGID * mode + r];
  return gamma * gamma / m->share.inertia[r];
}

/* Shares of the modes with the largest effective mass in direction r, in order. */
static void greatest(const model *m, int r, int n, double *share) {
  for (int found = 0, i = 0; i < m->eigen.n && found < n; i++)
    if (effective(m, i, r) > 0.01) share[found++] = effective(m, i, r);
}

/* A slender clamped bar (Euler-Bernoulli: 4 (sigma_i/beta_i)^2; axially, without Poisson's ratio,
 * 8/(2i - 1)^2 pi^2). */
static void slender_bar(void **state) {
  (void)state;
  const fem_material cork        = {.E = 2.1e11, .rho = 7850};
  const double       bending[3]  = {0.613065, 0.188302, 0.064739};
  const double       size[3]     = {1, 0.012, 0.021};
  const int          cells[3]    = {24, 1, 1};
  double             found[2][3] = {{0}}, axial[1] = {0};
  use_elements(MESH_HEX20);
  mesh_fe mesh = make_box(size, cells);
  use_elements(MESH_TET10);
  model *m = make(&mesh, &cork, 18);
  check_close(m->share.inertia[1], 7850 * size[0] * size[1] * size[2], 1e-12, "mass");
  check_close(m->share.inertia[3],
              m->share.inertia[0] * (size[1] * size[1] + size[2] * size[2]) / 3, 1e-12,
              "moment of inertia about the edge at the origin");
  for (int r = 1; r <= 2; r++) {
    greatest(m, r, 3, found[r - 1]);
    for (int i = 0; i < 3; i++)
      check_close(found[r - 1][i], bending[i], 5e-3, "effective mass in bending");
  }
  greatest(m, 0, 1, axial);
  check_close(axial[0], 8 / (SHB_PI * SHB_PI), 1e-4, "effective mass of the axial mode");
  release(m);
  mesh_fe_free(&mesh);
}

/* b^T M^-1 b, b the inertia forces of motion r: the sum over all modes of the mesh. */
static double all_modes(const model *m, int r) {
  Vec    load[FEM_RIGID], x;
  double inertia[FEM_RIGID], sum;
  KSP    ksp;
  for (int i = 0; i < FEM_RIGID; i++) MatCreateVecs(m->system.M, NULL, &load[i]);
  MatCreateVecs(m->system.M, NULL, &x);
  assert_int_equal(fem_rigid_load(&m->body, NULL, &m->system, load, inertia), 0);
  KSPCreate(PETSC_COMM_SELF, &ksp);
  KSPSetOperators(ksp, m->system.M, m->system.M);
  KSPSetType(ksp, KSPCG);
  KSPSetTolerances(ksp, 1e-13, PETSC_DEFAULT, PETSC_DEFAULT, 10000);
  assert_int_equal(KSPSolve(ksp, load[r], x), 0);
  VecDot(load[r], x, &sum);
  KSPDestroy(&ksp);
  VecDestroy(&x);
  for (int i = 0; i < FEM_RIGID; i++) VecDestroy(&load[i]);
  return sum;
}

/* All modes of a mesh: the sums are b^T M^-1 b. */
static void all_modes_add_up(void **state) {
  (void)state;
  const double size[3]  = {0.11, 0.07, 0.05};
  const int    cells[3] = {2, 1, 1};
  for (int kind = 0; kind < 2; kind++) {
    use_elements(kind ? MESH_HEX20 : MESH_TET10);
    mesh_fe mesh = make_box(size, cells);
    model  *m    = make(&mesh, &steel, 0);
    for (int r = 0; r < FEM_RIGID; r++) {
      double sum = 0;
      for (int i = 0; i < m->eigen.n; i++) sum += effective(m, i, r) * m->share.inertia[r];
      check_close(sum, all_modes(m, r), 1e-8, "sum of the effective masses");
      assert_true(sum < m->share.inertia[r]);
    }
    release(m);
    mesh_fe_free(&mesh);
  }
  use_elements(MESH_TET10);
}

/* The mass missing in the sum is that of the clamped nodes, of first order in the element size. */
static void what_is_missing_vanishes(void **state) {
  (void)state;
  const double size[3] = {0.11, 0.07, 0.05};
  double       missing[3];
  for (int i = 0; i < 3; i++) {
    const int cells[3] = {2 << i, 2, 1};
    mesh_fe   mesh     = make_box(size, cells);
    model    *m        = make(&mesh, &steel, 1);
    missing[i]         = 1 - all_modes(m, 1) / m->share.inertia[1];
    release(m);
    mesh_fe_free(&mesh);
  }
  print_message("missing of the mass: %.4f %.4f %.4f\n", missing[0], missing[1], missing[2]);
  for (int i = 0; i < 2; i++) check_close(missing[i] / missing[i + 1], 2, 0.1, "first order");
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(slender_bar),
                                     cmocka_unit_test(all_modes_add_up),
                                     cmocka_unit_test(what_is_missing_vanishes)};
  modal_session           session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  modal_session_end(&session, SHB_OK);
  return failed;
}
