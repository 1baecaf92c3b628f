/* Modes against other programs and closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "fem/body/energy.h"
#include "mesh/base/constants.h"
#include "modal/common/session.h"
#include "modal/eigen/eigen.h"
#include "tests/support/fem.h"

static void solve(const mesh_fe *mesh, const fem_material *material, fem_rules mass, int modes,
                  double shift, fem_system *system, modal_eigen *eigen) {
  modal_eigen_settings settings = {.modes = modes, .shift = shift};
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, mesh, material, mass, system), 0);
  if (modal_eigen_solve(system, &settings, eigen) != 0) fail_msg("%s", shb_message());
  assert_int_equal(eigen->n, modes);
}

static void release(fem_system *system, modal_eigen *eigen) {
  assert_int_equal(modal_eigen_destroy(eigen), 0);
  assert_int_equal(fem_system_destroy(system), 0);
}

/* phi^T M phi = I and phi^T K phi = Lambda. */
static void check_modes(const fem_system *system, const modal_eigen *eigen) {
  Vec    a, b, k_phi;
  double value;
  assert_int_equal(MatCreateVecs(system->K, NULL, &k_phi), 0);
  for (int i = 0; i < eigen->n; i++) {
    check_below(eigen->eigen_residual[i], 1e-9, "residual of a mode");
    MatDenseGetColumnVecRead(eigen->phi, i, &a);
    MatMult(system->K, a, k_phi);
    VecDot(a, k_phi, &value);
    check_close(value, eigen->lambda[i], 1e-9, "Rayleigh quotient");
    MatDenseRestoreColumnVecRead(eigen->phi, i, &a);
    for (int j = 0; j < eigen->n; j++) {
      MatDenseGetColumnVecRead(eigen->m_phi, j, &b);
      MatDenseGetColumnVecRead(eigen->phi, i, &a);
      VecDot(a, b, &value);
      check_below(value - (i == j), 1e-9, "M-orthonormality");
      MatDenseRestoreColumnVecRead(eigen->phi, i, &a);
      MatDenseRestoreColumnVecRead(eigen->m_phi, j, &b);
    }
  }
  VecDestroy(&k_phi);
}

/* CalculiX C3D10, 9684 nodes, same bar; the first three by Timoshenko's theory. */
static void steel_bar(void **state) {
  (void)state;
  const double calculix[6]   = {210.0503197, 618.2204161, 1301.270084,
                                2317.657808, 3534.732999, 3582.520868};
  const double timoshenko[3] = {208.47, 615.89, 1291.46};
  const double size[3]       = {0.2, 0.03, 0.01};
  const int    cells[3]      = {40, 6, 4};
  mesh_fe      mesh          = make_box(size, cells);
  for (int rule = FEM_STANDARD; rule <= FEM_CALCULIX; rule++) {
    fem_system  system;
    modal_eigen eigen;
    solve(&mesh, &steel, (fem_rules)rule, 6, 0, &system, &eigen);
    for (int i = 0; i < 6; i++) {
      double frequency = sqrt(eigen.lambda[i]) / SHB_TWO_PI;
      check_close(frequency, calculix[i], 1e-3, "frequency against CalculiX");
      if (i < 3) check_close(frequency, timoshenko[i], 1e-2, "frequency against Timoshenko");
    }
    check_modes(&system, &eigen);
    assert_int_equal(modal_eigen_drop_factor(&eigen), 0);
    assert_null(eigen.factor);
    check_modes(&system, &eigen); /* they do without the factor */
    release(&system, &eigen);
  }
  mesh_fe_free(&mesh);
}

/* Frequency of a mode from its strains, which are exact for a rigid motion. The solver's own
 * frequency differs by rounding. */
static double strain_frequency(const mesh_fe *mesh, const fem_system *system,
                               const modal_eigen *eigen, int mode) {
  fem_element *element = malloc(sizeof *element);
  double      *u       = malloc(3 * (size_t)mesh->n_nodes * sizeof *u);
  Vec          phi;
  assert_int_equal(fem_element_create(mesh->kind, FEM_STANDARD, element), 0);
  assert_int_equal(MatDenseGetColumnVecRead(eigen->phi, mode, &phi), 0);
  assert_int_equal(fem_system_gather(system, phi, u), 0);
  assert_int_equal(MatDenseRestoreColumnVecRead(eigen->phi, mode, &phi), 0);
  double lambda = strain_energy(mesh, &steel, element, u);
  free(element);
  free(u);
  return sqrt(lambda) / SHB_TWO_PI;
}

/* A free body: six zero frequencies, then the first elastic mode. */
static void free_body_has_six_rigid_modes(void **state) {
  (void)state;
  const double size[3] = {0.11, 0.07, 0.05}, shift = -1e8;
  const int    cells[3] = {4, 3, 2};
  mesh_fe      mesh     = make_box(size, cells);
  fem_system   system;
  modal_eigen  eigen;
  mesh.set[MESH_ROOT].n = 0;
  solve(&mesh, &steel, FEM_STANDARD, 8, shift, &system, &eigen);
  double elastic = eigen.lambda[6];
  assert_true(sqrt(elastic) / SHB_TWO_PI > 5000);
  for (int i = 0; i < 6; i++) check_below(eigen.lambda[i], 1e-9 * elastic, "rigid-body mode");
  double largest = 0;
  for (int i = 0; i < 6; i++) largest = fmax(largest, strain_frequency(&mesh, &system, &eigen, i));
  print_message("rigid-body modes up to %.1e of the first elastic one\n",
                largest * SHB_TWO_PI / sqrt(elastic));
  check_below(largest * SHB_TWO_PI, 1e-6 * sqrt(elastic), "frequency of a rigid-body mode");
  release(&system, &eigen);
  mesh_fe_free(&mesh);
}

/* Frequency of the mode with the largest motion along x. For nu = 0 the axial mode sin(pi x / 2L)
 * is exact. */
static double axial_frequency(const double size[3], const int cells[3]) {
  const fem_material cork = {.E = 2.1e11, .rho = 7850};
  mesh_fe            mesh = make_box(size, cells);
  double             best = 0, frequency = 0;
  fem_system         system;
  modal_eigen        eigen;
  Vec                ones, m_phi;
  solve(&mesh, &cork, FEM_STANDARD, 14, 0, &system, &eigen);
  assert_int_equal(MatCreateVecs(system.K, &ones, NULL), 0);
  assert_int_equal(VecZeroEntries(ones), 0);
  for (PetscInt r = 0; r < system.n_free; r++) VecSetValue(ones, 3 * r, 1, INSERT_VALUES);
  assert_int_equal(VecAssemblyBegin(ones), 0);
  assert_int_equal(VecAssemblyEnd(ones), 0);
  for (int i = 0; i < eigen.n; i++) {
    double share;
    MatDenseGetColumnVecRead(eigen.m_phi, i, &m_phi);
    VecDot(ones, m_phi, &share);
    MatDenseRestoreColumnVecRead(eigen.m_phi, i, &m_phi);
    if (share * share <= best) continue;
    best      = share * share;
    frequency = sqrt(eigen.lambda[i]) / SHB_TWO_PI;
  }
  /* its effective mass is 8/pi^2 of the bar's */
  check_close(best / (7850 * size[0] * size[1] * size[2]), 8 / (SHB_PI * SHB_PI), 1e-2,
              "effective mass");
  VecDestroy(&ones);
  release(&system, &eigen);
  mesh_fe_free(&mesh);
  return frequency;
}

static void smooth_mode_converges_with_order_four(void **state) {
  (void)state;
  const double size[3] = {0.1, 0.04, 0.03}, exact = sqrt(2.1e11 / 7850) / (4 * size[0]);
  double       error[3];
  for (int level = 0; level < 3; level++) {
    const int n        = 2 << level;
    const int cells[3] = {2 * n, n, n};
    error[level]       = axial_frequency(size, cells) / exact - 1;
    assert_true(error[level] > 0); /* from above */
  }
  check_below(error[2], 1e-7, "error on the finest mesh");
  for (int level = 0; level < 2; level++) {
    double order = log2(error[level] / error[level + 1]);
    print_message("axial mode: error %.3e -> %.3e, order %.2f\n", error[level], error[level + 1],
                  order);
    assert_true(order > 3.5 && order < 4.5);
  }
}

static void too_many_modes_is_one_line(void **state) {
  (void)state;
  const double         size[3]  = {0.1, 0.1, 0.1};
  const int            cells[3] = {1, 1, 1};
  mesh_fe              mesh     = make_box(size, cells);
  modal_eigen_settings settings = {.modes = 55};
  fem_system           system;
  modal_eigen          eigen;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
  assert_int_equal(modal_eigen_solve(&system, &settings, &eigen), PETSC_ERR_USER_INPUT);
  assert_string_equal(shb_message(), "modal.modes: 55 modes asked of a mesh with 54 free dofs");
  release(&system, &eigen);
  settings.modes = 54; /* all of them is allowed */
  solve(&mesh, &steel, FEM_STANDARD, 54, 0, &system, &eigen);
  check_modes(&system, &eigen);
  release(&system, &eigen);
  mesh_fe_free(&mesh);
}

/* Six frequencies of the steel bar for a number of hexahedra along it. */
static void bar_frequencies(int n, fem_rules rules, double frequency[6]) {
  const double size[3]  = {0.2, 0.03, 0.01};
  const int    cells[3] = {n, 3 * n / 20, n / 10};
  mesh_fe      mesh     = make_box(size, cells);
  fem_system   system;
  modal_eigen  eigen;
  solve(&mesh, &steel, rules, 6, 0, &system, &eigen);
  check_modes(&system, &eigen);
  for (int i = 0; i < 6; i++) frequency[i] = sqrt(eigen.lambda[i]) / SHB_TWO_PI;
  release(&system, &eigen);
  mesh_fe_free(&mesh);
}

/* Rules of 2x2x2 and 3x3x3 points converge to the same frequencies, the former from below the
 * latter. The first three agree with Timoshenko's theory. */
static void both_rules_of_hexahedra_meet(void **state) {
  (void)state;
  const double timoshenko[3] = {208.47, 615.89, 1291.46};
  double       gap[2][6], reduced[6], full[6];
  for (int level = 0; level < 2; level++) {
    bar_frequencies(20 << level, FEM_STANDARD, reduced);
    bar_frequencies(20 << level, FEM_FULL, full);
    for (int i = 0; i < 6; i++) gap[level][i] = full[i] / reduced[i] - 1;
  }
  for (int i = 0; i < 6; i++) {
    print_message("mode %d: %.4f Hz, 3x3x3 points %.1e above, half as fine %.1e\n", i + 1,
                  reduced[i], gap[1][i], gap[0][i]);
    assert_true(gap[1][i] > 0 && gap[1][i] < 1e-3 && gap[1][i] < 0.5 * gap[0][i]);
    if (i < 3) check_close(reduced[i], timoshenko[i], 1e-2, "frequency against Timoshenko");
  }
}

/* A box bent to an arc across and twisted along: a cambered blade of curved elements. */
static mesh_fe cambered_blade(const int cells[3]) {
  const double size[3] = {0.12, 0.05, 0.004}, radius = 0.035, twist = 0.6;
  mesh_fe      mesh = make_box(size, cells);
  for (int i = 0; i < mesh.n_nodes; i++) {
    double *x   = mesh.coordinates + 3 * i;
    double  arc = (x[1] - size[1] / 2) / radius, turn = twist * x[0] / size[0];
    double  outer = radius + x[2] - size[2] / 2, y = outer * sin(arc);
    double  z = outer * cos(arc) - radius;
    x[1]      = y * cos(turn) - z * sin(turn);
    x[2]      = y * sin(turn) + z * cos(turn);
  }
  return mesh;
}

static void blade_frequencies(mesh_kind kind, const int cells[3], fem_rules rules,
                              double frequency[6]) {
  fem_system  system;
  modal_eigen eigen;
  use_elements(kind);
  mesh_fe mesh = cambered_blade(cells);
  use_elements(MESH_TET10);
  solve(&mesh, &steel, rules, 6, 0, &system, &eigen);
  check_modes(&system, &eigen);
  for (int i = 0; i < 6; i++) frequency[i] = sqrt(eigen.lambda[i]) / SHB_TWO_PI;
  release(&system, &eigen);
  mesh_fe_free(&mesh);
}

/* Curved tetrahedra converge from above; four points are nearer than 27, in every mode. */
static void four_points_stiffen_curved_tetrahedra_less(void **state) {
  (void)state;
  const int finest[3] = {24, 12, 3}, cells[2][3] = {{8, 4, 1}, {16, 8, 1}};
  double    reference[6], reduced[2][6], full[2][6];
  blade_frequencies(MESH_HEX20, finest, FEM_STANDARD, reference);
  for (int level = 0; level < 2; level++) {
    blade_frequencies(MESH_TET10, cells[level], FEM_STANDARD, reduced[level]);
    blade_frequencies(MESH_TET10, cells[level], FEM_FULL, full[level]);
  }
  for (int i = 0; i < 6; i++) {
    double above[2], more[2];
    for (int level = 0; level < 2; level++) {
      above[level] = reduced[level][i] / reference[i] - 1;
      more[level]  = full[level][i] / reference[i] - 1;
      assert_true(above[level] > 0 && more[level] > 1.03 * above[level]);
    }
    print_message("mode %d: 4 points %.2e and %.2e above, 27 points %.2e and %.2e\n", i + 1,
                  above[0], above[1], more[0], more[1]);
    assert_true(above[1] < 0.3 * above[0]);
  }
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(steel_bar),
      cmocka_unit_test(free_body_has_six_rigid_modes),
      cmocka_unit_test(smooth_mode_converges_with_order_four),
      cmocka_unit_test(too_many_modes_is_one_line),
      cmocka_unit_test(four_points_stiffen_curved_tetrahedra_less),
  };
  const struct CMUnitTest of_hexahedra[] = {
      cmocka_unit_test(both_rules_of_hexahedra_meet),
      cmocka_unit_test(free_body_has_six_rigid_modes),
  };
  modal_session session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests_name("tet10", tests, NULL, NULL);
  failures += cmocka_run_group_tests_name("hex20", of_hexahedra, use_hexahedra, NULL);
  session.fault = false;
  modal_session_end(&session, SHB_OK);
  return failures;
}
