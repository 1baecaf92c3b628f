/* Stress of mode shapes: longitudinal modes in closed form, bending against beam theory. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "fem/body/assemble.h"
#include "fem/body/stress.h"
#include "mesh/base/constants.h"
#include "modal/common/session.h"
#include "modal/eigen/eigen.h"
#include "tests/support/fem.h"

enum { MODES = 6 };

/* No lateral contraction, so that plane sections stay plane and the clamp adds no stress. */
static const fem_material cork = {.E = 2.1e11, .rho = 7850};

/* Modes of the bar with the stresses of mode; the caller frees stress and the mesh. */
static int solve(const double size[3], const int cells[3], double frequency[MODES], mesh_fe *mesh,
                 float (**stress)[MODES][FEM_STRESSES]) {
  modal_eigen_settings wanted = {.modes = MODES, .tolerance = 1e-12};
  fem_system           system;
  modal_eigen          eigen   = {0};
  fem_element         *element = make_element_tables(FEM_FULL);
  *mesh                        = make_box(size, cells);
  const size_t   n             = (size_t)mesh->n_nodes;
  const fem_body body          = {mesh, &cork, element, {MESH_AXIS_X, 0}, 0};
  double        *shape         = malloc(3 * n * MODES * sizeof *shape);
  float         *all           = malloc(FEM_STRESSES * n * MODES * sizeof *all);
  *stress                      = malloc(n * sizeof **stress);
  assert_true(element && shape && all && *stress);
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, mesh, &cork, FEM_FULL, &system), 0);
  assert_int_equal(modal_eigen_solve(&system, &wanted, &eigen), 0);
  for (int i = 0; i < MODES; i++) {
    Vec phi;
    frequency[i] = sqrt(eigen.lambda[i]) / SHB_TWO_PI;
    assert_int_equal(MatDenseGetColumnVecRead(eigen.phi, i, &phi), 0);
    assert_int_equal(fem_system_gather(&system, phi, shape + 3 * n * (size_t)i), 0);
    assert_int_equal(MatDenseRestoreColumnVecRead(eigen.phi, i, &phi), 0);
  }
  fem_nodal_stress_change(&body, NULL, MODES, shape, all);
  for (size_t k = 0; k < n; k++)
    for (size_t i = 0; i < MODES; i++)
      for (size_t c = 0; c < FEM_STRESSES; c++)
        (*stress)[k][i][c] = all[(i * n + k) * FEM_STRESSES + c];
  free(shape), free(all), free(element);
  modal_eigen_destroy(&eigen);
  fem_system_destroy(&system);
  return 0;
}

static int nearest(const double frequency[MODES], double wanted) {
  int best = 0;
  for (int i = 1; i < MODES; i++)
    if (fabs(frequency[i] - wanted) < fabs(frequency[best] - wanted)) best = i;
  return best;
}

/* u = a sin(k x) with k = pi/(2 L) and a^2 rho V/2 = 1: stress E a k cos(k x). */
static double longitudinal_error(int n) {
  const double size[3]  = {0.2, 0.16, 0.14};
  const int    cells[3] = {2 * n, n, n};
  mesh_fe      mesh;
  double       frequency[MODES], error = 0, k = SHB_PI / 2 / size[0];
  double       a = sqrt(2 / (cork.rho * size[0] * size[1] * size[2])), most = cork.E * a * k;
  float(*stress)[MODES][FEM_STRESSES];
  solve(size, cells, frequency, &mesh, &stress);
  int    mode = nearest(frequency, k * sqrt(cork.E / cork.rho) / SHB_TWO_PI), at = 0;
  double sign = 0;
  for (int i = 0; i < mesh.n_nodes; i++)
    if (fabs(mesh.coordinates[3 * i]) < 1e-9) at = i;
  sign = copysign(1, stress[at][mode][0]);
  for (int i = 0; i < mesh.n_nodes; i++)
    for (int c = 0; c < FEM_STRESSES; c++) {
      double wanted = c == 0 ? most * cos(k * mesh.coordinates[3 * i]) : 0;
      error         = fmax(error, fabs(sign * stress[i][mode][c] - wanted));
    }
  free(stress);
  mesh_fe_free(&mesh);
  return error / most;
}

static void longitudinal_stress_is_of_second_order(void **state) {
  (void)state;
  double coarse = longitudinal_error(2), fine = longitudinal_error(4);
  print_message("greatest error of the stress %.2e, with half the size %.2e (1/%.1f)\n", coarse,
                fine, coarse / fine);
  check_below(fine, 6e-3, "stress");
  assert_true(coarse / fine > 3.4);
}

/* First bending of a cantilever: w = a (cosh - cos - s (sinh - sin))(b x), b L = 1.8751, mean
 * square a^2 over the length, rho V a^2 = 1. Stress E w'' h/2 in the outer fibre at half the
 * length. The thickness is a fortieth of the length, so shear changes it by about its square. */
static void bending_agrees_with_beam_theory(void **state) {
  (void)state;
  const double size[3]  = {0.4, 0.014, 0.01};
  const int    cells[3] = {40, 2, 4};
  mesh_fe      mesh;
  double       frequency[MODES], bL = 1.875104068711961, b = bL / size[0], x = size[0] / 2;
  double       s      = (cosh(bL) + cos(bL)) / (sinh(bL) + sin(bL));
  double       a      = 1 / sqrt(cork.rho * size[0] * size[1] * size[2]);
  double       w2     = a * b * b * (cosh(b * x) + cos(b * x) - s * (sinh(b * x) + sin(b * x)));
  double       wanted = cork.E * w2 * size[2] / 2;
  double       first  = b * b * sqrt(cork.E / cork.rho / 12) * size[2] / SHB_TWO_PI;
  float(*stress)[MODES][FEM_STRESSES];
  solve(size, cells, frequency, &mesh, &stress);
  int mode = nearest(frequency, first), found = 0;
  for (int i = 0; i < mesh.n_nodes; i++) {
    const double *p = mesh.coordinates + 3 * i;
    if (fabs(p[0] - x) > 1e-9 || fabs(p[2] - size[2]) > 1e-9) continue;
    check_close(fabs(stress[i][mode][0]), wanted, 1e-2, "stress in the outer fibre");
    if (found++ == 0)
      print_message("%.6g Hz (beam %.6g), stress %.5g Pa kg^-1/2 (beam %.5g)\n", frequency[mode],
                    first, fabs(stress[i][mode][0]), wanted);
  }
  assert_true(found >= 2);
  free(stress);
  mesh_fe_free(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(longitudinal_stress_is_of_second_order),
                                     cmocka_unit_test(bending_agrees_with_beam_theory)};
  if (SlepcInitialize(NULL, NULL, NULL, NULL)) return 1;
  int failures = run_with_both_elements(tests, NULL, NULL);
  SlepcFinalize();
  return failures;
}
