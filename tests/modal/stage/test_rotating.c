/* Modes of rotating beams: stiffening and softening against beam theory and published
 * frequencies. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/body/equilibrium.h"
#include "fem/solver/petsc_error.h"
#include "modal/eigen/eigen.h"
#include "tests/support/box.h"
#include "tests/support/fem.h"

enum { MODES = 6 };

/* No lateral contraction: a clamp that hinders it would shorten the beam by a fraction of its
 * width. */
static const fem_material material = {.E = 2.1e11, .rho = 7850};

/* A beam along x, clamped at x = hub, rotating about y: flap is along y, in-plane motion along z.
 * The section is width along y and 1.3 width along z, so that the two motions do not couple. */
typedef struct {
  double length, width, hub;
  int    cells;
} beam;

static mesh_fe make_beam(const beam *b) {
  const double size[3]  = {b->length, b->width, 1.3 * b->width};
  const int    cells[3] = {b->cells, used_elements() == MESH_HEX20 ? 2 : 1, 1};
  mesh_fe      mesh     = make_box(size, cells);
  for (int i = 0; i < mesh.n_nodes; i++) {
    mesh.coordinates[3 * i] += b->hub;
    mesh.coordinates[3 * i + 1] -= b->width / 2;
    mesh.coordinates[3 * i + 2] -= 1.3 * b->width / 2;
  }
  return mesh;
}

/* Eigenvalues at a speed: flap modes (along y) and in-plane modes (along z). Torsion and axial
 * modes are omitted. */
static shb_status solve(const beam *b, double speed, double flap[MODES], double plane[MODES]) {
  mesh_fe              mesh    = make_beam(b);
  fem_element         *element = malloc(sizeof *element);
  const fem_body       body    = {&mesh, &material, element, {MESH_AXIS_Y, speed}, 0};
  modal_eigen_settings wanted  = {.modes = MODES, .tolerance = 1e-12};
  fem_system           system;
  fem_equilibrium      at    = {0};
  modal_eigen          eigen = {0};
  double              *u     = malloc(3 * (size_t)mesh.n_nodes * sizeof *u);
  int                  n[2]  = {0};
  assert_true(element && u);
  assert_int_equal(fem_element_create(mesh.kind, FEM_STANDARD, element), 0);
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &material, FEM_STANDARD, &system), 0);
  PetscErrorCode code = speed == 0 ? 0 : fem_equilibrium_solve(&body, &system, NULL, &at);
  if (code == 0) code = modal_eigen_solve(&system, &wanted, &eigen);
  for (int i = 0; code == 0 && i < MODES; i++) {
    Vec    phi;
    double y = 0, z = 0, x = 0;
    assert_int_equal(MatDenseGetColumnVecRead(eigen.phi, i, &phi), 0);
    assert_int_equal(fem_system_gather(&system, phi, u), 0);
    assert_int_equal(MatDenseRestoreColumnVecRead(eigen.phi, i, &phi), 0);
    for (int k = 0; k < mesh.n_nodes; k++) {
      x += u[3 * k] * u[3 * k];
      y += u[3 * k + 1] * u[3 * k + 1];
      z += u[3 * k + 2] * u[3 * k + 2];
    }
    double *to = y > 10 * (x + z) ? flap + n[0]++ : z > 10 * (x + y) ? plane + n[1]++ : NULL;
    if (to) *to = tangent_energy(&body, at.displacement, u);
  }
  modal_eigen_destroy(&eigen);
  fem_equilibrium_free(&at);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
  free(element);
  free(u);
  return fem_petsc_status(code);
}

/* ------------------------------------------------------------------ beam theory */

/* First mode of a clamped-free Euler-Bernoulli beam, s in 0..1, and its slope. */
static double mode(double s, double *slope) {
  const double b     = 1.87510406871196117;
  const double ratio = (cosh(b) + cos(b)) / (sinh(b) + sin(b));
  *slope             = b * (sinh(b * s) + sin(b * s) - ratio * (cosh(b * s) - cos(b * s)));
  return cosh(b * s) - cos(b * s) - ratio * (sinh(b * s) - sin(b * s));
}

/* Southwell's coefficient of the first flap mode at low speed, w^2 = w0^2 + S Omega^2, by Simpson's
 * rule:
 *
 *   S = int T phi'^2 / int phi^2,   T = (1 - s^2)/2 + hub (1 - s), hub in beam lengths. */
static double southwell(double hub) {
  enum { STEPS = 2000 };
  double top = 0, bottom = 0;
  for (int i = 0; i <= STEPS; i++) {
    double s = (double)i / STEPS, weight = i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2, slope;
    double phi = mode(s, &slope);
    top += weight * ((1 - s * s) / 2 + hub * (1 - s)) * slope * slope;
    bottom += weight * phi * phi;
  }
  return top / bottom;
}

/* w0 by beam theory, rad/s. */
static double slender_frequency(const beam *b) {
  return 3.5160152685 * b->width / sqrt(12) / (b->length * b->length) *
         sqrt(material.E / material.rho);
}

/* The published value for hub 0 is 1.193. For beams of equal length the error of the theory falls
 * with the square of the width. */
static void stiffening_is_southwells(void **state) {
  (void)state;
  double flap_error[3], plane_error[3], S[3];
  check_close(southwell(0), 1.193, 5e-4, "Southwell's coefficient, hub 0");
  for (int level = 0; level < 3; level++) {
    const int    parts = 10 << level;
    const beam   b     = {0.4, 0.4 / parts, 0.3, parts};
    const double speed = 0.02 * slender_frequency(&b), square = speed * speed;
    double       flap[2][MODES], plane[2][MODES];
    assert_int_equal(solve(&b, 0, flap[0], plane[0]), SHB_OK);
    assert_int_equal(solve(&b, speed, flap[1], plane[1]), SHB_OK);
    S[level]           = (flap[1][0] - flap[0][0]) / square;
    double in_plane    = (plane[1][0] - plane[0][0]) / square;
    flap_error[level]  = S[level] / southwell(0.75) - 1;
    plane_error[level] = S[level] - in_plane - 1;
    print_message("width/length 1/%d: S %.6f (beam theory %.6f), flap less in-plane %.6f (1)\n",
                  parts, S[level], southwell(0.75), S[level] - in_plane);
  }
  for (int i = 0; i < 2; i++) {
    double order[2] = {log2(flap_error[i] / flap_error[i + 1]),
                       log2(plane_error[i] / plane_error[i + 1])};
    print_message("orders in the width: %.2f, %.2f\n", order[0], order[1]);
    assert_true(order[0] > 1.5);
    check_below(order[1] - 2, 0.3, "order of the difference of the planes");
  }
  check_close(S[2] + (S[2] - S[1]) / 3, southwell(0.75), 2e-5,
              "Southwell's coefficient, extrapolated");
  check_below(plane_error[2], 1e-3, "difference of the planes");
}

/* Flap frequencies of a uniform beam, hub 0, in units of sqrt(EI/(rho A L^4)), over the speed in
 * the same unit. Source: Wright, Smith, Thresher, Wang 1982, J. Appl. Mech. 49, 197. */
static void frequencies_are_the_published_ones(void **state) {
  (void)state;
  const double published[3][3] = {{0, 3.5160, 22.0345}, {3, 4.7973, 23.3203}, {6, 7.3604, 26.8091}};
  const beam   b               = {0.5, 0.005, 0, 60};
  const double unit            = slender_frequency(&b) / 3.5160152685;
  double       flap[3][MODES], plane[MODES];
  for (int i = 0; i < 3; i++)
    assert_int_equal(solve(&b, unit * published[i][0], flap[i], plane), SHB_OK);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 2; k++) {
      double w = sqrt(flap[i][k]) / unit;
      print_message("speed %g, flap %d: %.4f (published %.4f)\n", published[i][0], k + 1, w,
                    published[i][k + 1]);
      check_close(w, published[i][k + 1], 3e-3, "rotating beam");
    }
}

/* Clamped at its outer end the beam is compressed. It buckles where its lowest eigenvalue, nearly
 * linear in Omega^2, becomes 0. Below that speed there are modes, above it an error. */
static void buckling_is_refused(void **state) {
  (void)state;
  const beam b = {0.2, 0.004, -0.5, 12};
  double     low[MODES], high[MODES], last[MODES], plane[MODES];
  assert_int_equal(solve(&b, 150, low, plane), SHB_OK);
  assert_int_equal(solve(&b, 250, high, plane), SHB_OK);
  assert_true(high[0] < plane[0]);
  double critical = sqrt(250. * 250 + high[0] * (250. * 250 - 150. * 150) / (low[0] - high[0]));
  print_message("buckles near %.4g rad/s\n", critical);
  assert_int_equal(solve(&b, 0.98 * critical, last, plane), SHB_OK);
  assert_true(last[0] > 0 && last[0] < 0.2 * high[0]);
  assert_int_equal(solve(&b, 1.02 * critical, last, plane), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "rotor.speed"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stiffening_is_southwells),
      cmocka_unit_test(frequencies_are_the_published_ones),
      cmocka_unit_test(buckling_is_refused),
  };
  if (SlepcInitialize(NULL, NULL, NULL, NULL)) return 1;
  PetscPushErrorHandler(fem_petsc_error_handler, NULL);
  int failures = run_with_both_elements(tests, NULL, NULL);
  PetscPopErrorHandler();
  SlepcFinalize();
  return failures;
}
