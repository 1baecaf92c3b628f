/* Large displacements of one element: closed forms, rigid motions, and the tangent as the derivative of the force. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/finite.h"
#include "tests/fem/support.h"

typedef double nodal[10][3];
typedef const double (*fixed)[3];

static fem_tet10 *element;

/* amount 0: straight sides; else mid-side nodes pulled out of line. */
static void make_element(double amount, nodal x) {
  static const int edge[6][2]   = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};
  const double     corner[4][3] = {
          {.11, .07, -.03}, {1.23, .19, .05}, {.31, .93, -.11}, {.17, .29, 1.37}};
  for (int c = 0; c < 4; c++)
    for (int d = 0; d < 3; d++) x[c][d] = corner[c][d];
  for (int e = 0; e < 6; e++)
    for (int d = 0; d < 3; d++)
      x[4 + e][d] =
          (x[edge[e][0]][d] + x[edge[e][1]][d]) / 2 + amount * sin(3.7 * e + 1.9 * d + 14.8);
}

/* Some field of size amount. */
static void make_field(double amount, double phase, nodal u) {
  for (int i = 0; i < 10; i++)
    for (int d = 0; d < 3; d++) u[i][d] = amount * sin(2.3 * i + 1.7 * d * d + phase);
}

/* u = F x - x + offset */
static void deform(const double F[3][3], const nodal x, nodal u) {
  for (int i = 0; i < 10; i++)
    for (int d = 0; d < 3; d++)
      u[i][d] = F[d][0] * x[i][0] + F[d][1] * x[i][1] + F[d][2] * x[i][2] - x[i][d] + .7 * (d + 1);
}

/* Rotation by 1.1 rad about (1, 2, -2)/3 (Rodrigues). */
static void make_rotation(double Q[3][3]) {
  const double a[3] = {1. / 3, 2. / 3, -2. / 3}, c = cos(1.1), s = sin(1.1);
  const double cross[3][3] = {{0, -a[2], a[1]}, {a[2], 0, -a[0]}, {-a[1], a[0], 0}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) Q[i][j] = c * (i == j) + s * cross[i][j] + (1 - c) * a[i] * a[j];
}

static double largest(const double *v, int n) {
  double most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(v[i]));
  return most;
}

static void tangent_at_rest_is_the_stiffness(void **state) {
  (void)state;
  for (int curved = 0; curved < 2; curved++) {
    nodal  x, u = {{0}}, f;
    double K[30][30], T[30][30];
    make_element(.04 * curved, x);
    assert_int_equal(fem_tet10_is_straight((fixed)x), !curved);
    fem_tet10_stiffness(element, &steel, (fixed)x, K);
    fem_tet10_tangent(element, &steel, (fixed)x, (fixed)u, T);
    fem_tet10_force(element, &steel, (fixed)x, (fixed)u, f);
    check_below(largest(&f[0][0], 30), 0, "force at rest");
    for (int i = 0; i < 900; i++)
      check_below((&T[0][0])[i] - (&K[0][0])[i], 1e-14 * largest(&K[0][0], 900), "tangent at rest");
  }
}

/* A finite rotation strains nothing, and turns the stiffness: K = Q K0 Q^T. */
static void rotation_makes_no_force(void **state) {
  (void)state;
  nodal  x, u, f;
  double Q[3][3], K[30][30], T[30][30], scale;
  make_rotation(Q);
  make_element(.04, x);
  deform((fixed)Q, (fixed)x, u);
  fem_tet10_stiffness(element, &steel, (fixed)x, K);
  scale = largest(&K[0][0], 900);
  fem_tet10_force(element, &steel, (fixed)x, (fixed)u, f);
  check_below(largest(&f[0][0], 30), 1e-14 * scale, "force of a rotation");
  check_below(fem_tet10_stress(element, &steel, (fixed)x, (fixed)u), 1e-13 * steel.E, "stress");
  fem_tet10_tangent(element, &steel, (fixed)x, (fixed)u, T);
  for (int i = 0; i < 10; i++)
    for (int j = 0; j < 10; j++)
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
          double turned = 0;
          for (int c = 0; c < 3; c++)
            for (int d = 0; d < 3; d++) turned += Q[a][c] * K[3 * i + c][3 * j + d] * Q[b][d];
          check_below(T[3 * i + a][3 * j + b] - turned, 1e-13 * scale, "turned tangent");
        }
}

/* Stretch s along x, then a rotation: S = E (1 - nu)/((1 + nu)(1 - 2 nu)) e along x and lambda e across, e = (s^2 - 1)/2;
 * Cauchy s S_x and S_y / s; nodal forces P int g, whose moment about any axis vanishes and whose virial is P F^T V. */
static void stretch_matches_the_closed_form(void **state) {
  (void)state;
  const double s = 1.13, e = (s * s - 1) / 2, nu = steel.nu;
  const double lambda = steel.E * nu / ((1 + nu) * (1 - 2 * nu)), mu = steel.E / (2 * (1 + nu));
  const double along = s * (lambda + 2 * mu) * e, across = lambda * e / s;
  double       Q[3][3], F[3][3], turned, virial = 0, m[10][10], volume = 0;
  nodal        x, u, f;
  make_rotation(Q);
  make_element(.03, x);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) F[a][b] = Q[a][b] * (b == 0 ? s : 1);
  deform((fixed)F, (fixed)x, u);
  check_close(fem_tet10_stress(element, &steel, (fixed)x, (fixed)u), along - across, 1e-12,
              "von Mises stress");
  fem_tet10_force(element, &steel, (fixed)x, (fixed)u, f);
  fem_tet10_mass(element, 1, (fixed)x, m);
  for (int i = 0; i < 100; i++) volume += (&m[0][0])[i];
  for (int d = 0; d < 3; d++) { /* sum of f . (x + u) = V tr(P F^T) = V J tr(sigma), J = s */
    turned = 0;
    for (int i = 0; i < 10; i++) {
      turned += f[i][d];
      virial += f[i][d] * (x[i][d] + u[i][d]);
    }
    check_below(turned, 1e-12 * steel.E, "resultant");
  }
  check_close(virial, volume * s * (along + 2 * across), 1e-12, "virial");
}

/* The force is a cubic of the displacement: central differences err by c h^2 exactly. */
static void tangent_is_the_derivative_of_the_force(void **state) {
  (void)state;
  nodal  x, u, direction, shifted, forward, backward;
  double K[30][30], error[3], slope[30] = {0};
  make_element(.04, x);
  make_field(.2, .4, u);
  make_field(1, 1.9, direction);
  fem_tet10_tangent(element, &steel, (fixed)x, (fixed)u, K);
  for (int i = 0; i < 30; i++)
    for (int j = 0; j < 30; j++) {
      slope[i] += K[i][j] * (&direction[0][0])[j];
      assert_true(K[i][j] == K[j][i]);
    }
  for (int level = 0; level < 3; level++) {
    double h = .1 / (1 << level), difference[30];
    for (int sign = -1; sign <= 1; sign += 2) {
      for (int i = 0; i < 30; i++)
        (&shifted[0][0])[i] = (&u[0][0])[i] + sign * h * (&direction[0][0])[i];
      fem_tet10_force(element, &steel, (fixed)x, (fixed)shifted, sign < 0 ? backward : forward);
    }
    for (int i = 0; i < 30; i++)
      difference[i] = ((&forward[0][0])[i] - (&backward[0][0])[i]) / (2 * h) - slope[i];
    error[level] = largest(difference, 30) / largest(slope, 30);
  }
  assert_true(error[0] > 1e-3); /* the cubic term is there */
  check_close(error[0] / error[1], 4, 1e-9, "ratio of errors");
  check_close(error[1] / error[2], 4, 1e-9, "ratio of errors");
}

static int tables(void **state) {
  (void)state;
  element = malloc(sizeof *element);
  return element && fem_tet10_create(FEM_MASS_EXACT, element) == 0 ? 0 : -1;
}

static int free_tables(void **state) {
  (void)state;
  free(element);
  return 0;
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tangent_at_rest_is_the_stiffness),
      cmocka_unit_test(rotation_makes_no_force),
      cmocka_unit_test(stretch_matches_the_closed_form),
      cmocka_unit_test(tangent_is_the_derivative_of_the_force),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  int failures = cmocka_run_group_tests(tests, tables, free_tables);
  PetscFinalize();
  return failures;
}
