/* Quadrature and the 10-node tetrahedron against closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/element/element.h"
#include "tests/support/fem.h"

#include <petscblaslapack.h>

/* A straight-sided element, and the same with displaced mid-side nodes. */
static void straight_element(double x[10][3]) {
  static const int edge[6][2]   = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};
  const double     corner[4][3] = {
          {.11, .07, -.03}, {1.23, .19, .05}, {.31, .93, -.11}, {.17, .29, 1.37}};
  for (int c = 0; c < 4; c++)
    for (int d = 0; d < 3; d++) x[c][d] = corner[c][d];
  for (int e = 0; e < 6; e++)
    for (int d = 0; d < 3; d++) x[4 + e][d] = (x[edge[e][0]][d] + x[edge[e][1]][d]) / 2;
}

static void curved_element(double amount, double x[10][3]) {
  straight_element(x);
  for (int e = 4; e < 10; e++)
    for (int d = 0; d < 3; d++) x[e][d] += amount * sin((3.7 + d) * e + 1.9 * d);
}

static double factorial(int n) {
  double f = 1;
  for (int i = 2; i <= n; i++) f *= i;
  return f;
}

/* Points come back from the shape functions: x = sum N_i x_i on the reference element. */
static void reference_point(const double shape[10], double at[3]) {
  const double corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int    edge[6][2]   = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};
  for (int d = 0; d < 3; d++) {
    at[d] = 0;
    for (int c = 0; c < 4; c++) at[d] += shape[c] * corner[c][d];
    for (int e = 0; e < 6; e++)
      at[d] += shape[4 + e] * (corner[edge[e][0]][d] + corner[edge[e][1]][d]) / 2;
  }
}

static double monomial_error(const fem_rule *rule, int a, int b, int c) {
  double sum = 0, exact = factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + 3);
  for (int p = 0; p < rule->n; p++) {
    double at[3];
    reference_point(rule->shape[p], at);
    sum += rule->weight[p] * pow(at[0], a) * pow(at[1], b) * pow(at[2], c);
  }
  return fabs(sum - exact) / exact;
}

static void check_degree(const fem_rule *rule, int degree) {
  double above = 0;
  for (int a = 0; a <= degree + 1; a++)
    for (int b = 0; a + b <= degree + 1; b++)
      for (int c = 0; a + b + c <= degree + 1; c++) {
        double error = monomial_error(rule, a, b, c);
        if (a + b + c <= degree)
          check_below(error, 1e-12, "monomial");
        else
          above = fmax(above, error);
      }
  assert_true(above > 1e-6); /* and no further */
}

static void tetrahedron_rules_have_their_degree(void **state) {
  (void)state;
  fem_rule rule;
  fem_tet_rule_4(&rule);
  check_degree(&rule, 2);
  for (int n = 2; n <= 4; n++) {
    assert_int_equal(fem_tet_rule_conical(n, &rule), 0);
    check_degree(&rule, 2 * n - 1);
  }
}

static void triangle_rule_is_exact_to_degree_seven(void **state) {
  (void)state;
  fem_face_rule rule;
  assert_int_equal(fem_face_rule_create(MESH_TET10, &rule), 0);
  for (int a = 0; a <= 7; a++)
    for (int b = 0; a + b <= 7; b++) {
      double sum = 0, exact = factorial(a) * factorial(b) / factorial(a + b + 2);
      for (int p = 0; p < rule.n; p++) {
        const double *N = rule.shape[p]; /* r = N1 + (N3 + N4)/2, s = N2 + (N4 + N5)/2 */
        sum += rule.weight[p] * pow(N[1] + (N[3] + N[4]) / 2, a) * pow(N[2] + (N[4] + N[5]) / 2, b);
      }
      check_close(sum, exact, 1e-12, "monomial");
    }
}

/* Closed form of the straight element's consistent mass, in units of rho V / 420. */
static void mass_matches_the_closed_form(void **state) {
  (void)state;
  static const int edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};
  fem_element      element;
  double           x[10][3], m[10][10], J[3][3];
  straight_element(x);
  for (int a = 0; a < 3; a++)
    for (int d = 0; d < 3; d++) J[a][d] = x[a + 1][d] - x[0][d];
  double volume = (J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) -
                   J[0][1] * (J[1][0] * J[2][2] - J[1][2] * J[2][0]) +
                   J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0])) /
                  6;
  assert_int_equal(fem_element_create(MESH_TET10, FEM_STANDARD, &element), 0);
  fem_element_mass(&element, 7850, x, &m[0][0]);
  double unit = 7850 * volume / 420;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) check_close(m[i][j], (i == j ? 6 : 1) * unit, 1e-12, "corners");
  for (int i = 0; i < 4; i++)
    for (int e = 0; e < 6; e++)
      check_close(m[i][4 + e], (i == edge[e][0] || i == edge[e][1] ? -4 : -6) * unit, 1e-12,
                  "corner and side");
  for (int e = 0; e < 6; e++)
    for (int f = 0; f < 6; f++) {
      int shared = (edge[e][0] == edge[f][0] || edge[e][0] == edge[f][1]) +
                   (edge[e][1] == edge[f][0] || edge[e][1] == edge[f][1]);
      check_close(m[4 + e][4 + f],
                  (shared == 2   ? 32
                   : shared == 1 ? 16
                                 : 8) *
                      unit,
                  1e-12, "sides");
    }
}

/* Work of K on two displacement fields given at the nodes. */
static double work(double K[30][30], const double *u, const double *v) {
  double sum = 0;
  for (int i = 0; i < 30; i++)
    for (int j = 0; j < 30; j++) sum += u[i] * K[i][j] * v[j];
  return sum;
}

/* The stiffness is symmetric. A rotation about a skew axis through a skew point gives no force. */
static void check_rigid(const fem_element *element, const double x[10][3]) {
  double K[30][30], u[30], largest = 0;
  fem_element_stiffness(element, &steel, x, &K[0][0]);
  for (int i = 0; i < 30; i++) largest = fmax(largest, K[i][i]);
  for (int i = 0; i < 10; i++) {
    u[3 * i]     = .7 + .3 * x[i][2] - 1.1 * x[i][1];
    u[3 * i + 1] = -.2 + 1.1 * x[i][0] - .5 * x[i][2];
    u[3 * i + 2] = .4 + .5 * x[i][1] - .3 * x[i][0];
  }
  for (int i = 0; i < 30; i++) {
    double force = 0;
    for (int j = 0; j < 30; j++) {
      force += K[i][j] * u[j];
      assert_true(fabs(K[i][j] - K[j][i]) <= 1e-14 * largest);
    }
    check_below(force, 1e-12 * largest, "force of a rigid motion");
  }
}

/* Homogeneous strain: twice the energy divided by sigma : epsilon V, less 1. V is that of the
 * mass. */
static double energy_error(const fem_element *element, const double x[10][3]) {
  const double e[3][3] = {{1.3e-3, .2e-3, -.4e-3}, {.2e-3, -.7e-3, .6e-3}, {-.4e-3, .6e-3, .9e-3}};
  double       mu = 2.1e11 / 2.6, lambda = 2 * mu * .3 / .4, trace = 0, square = 0, volume = 0;
  double       K[30][30], m[10][10], u[30];
  fem_element_stiffness(element, &steel, x, &K[0][0]);
  fem_element_mass(element, 1, x, &m[0][0]);
  for (int i = 0; i < 10; i++)
    for (int j = 0; j < 10; j++) volume += m[i][j];
  for (int a = 0; a < 3; a++) {
    trace += e[a][a];
    for (int b = 0; b < 3; b++) square += e[a][b] * e[a][b];
  }
  for (int i = 0; i < 10; i++)
    for (int a = 0; a < 3; a++)
      u[3 * i + a] = e[a][0] * x[i][0] + e[a][1] * x[i][1] + e[a][2] * x[i][2];
  return work(K, u, u) / ((lambda * trace * trace + 2 * mu * square) * volume) - 1;
}

/* The determinant of J is a cubic where sides are curved: four points err in the volume. */
static void stiffness_knows_rigid_motions_and_constant_strain(void **state) {
  (void)state;
  const fem_rules rules[2] = {FEM_STANDARD, FEM_FULL};
  for (int r = 0; r < 2; r++) {
    fem_element element;
    double      x[10][3];
    assert_int_equal(fem_element_create(MESH_TET10, rules[r], &element), 0);
    straight_element(x);
    assert_true(fem_element_is_straight(&element, x));
    check_rigid(&element, x);
    check_below(energy_error(&element, x), 1e-12, "energy");
    curved_element(.04, x);
    assert_false(fem_element_is_straight(&element, x));
    check_rigid(&element, x);
    double error = fabs(energy_error(&element, x));
    print_message("error of the energy of a constant strain: %.1e\n", error);
    if (rules[r] == FEM_FULL)
      check_below(error, 1e-12, "energy");
    else
      assert_true(error > 1e-6 && error < 1e-2);
  }
}

static void four_points_unless_full(void **state) {
  (void)state;
  fem_element standard, calculix, full;
  double      x[10][3], K[3][30][30], m[3][10][10];
  assert_int_equal(fem_element_create(MESH_TET10, FEM_STANDARD, &standard), 0);
  assert_int_equal(fem_element_create(MESH_TET10, FEM_CALCULIX, &calculix), 0);
  assert_int_equal(fem_element_create(MESH_TET10, FEM_FULL, &full), 0);
  const fem_element *element[3] = {&standard, &calculix, &full};
  curved_element(.04, x);
  for (int r = 0; r < 3; r++) {
    assert_int_equal(fem_element_stiffness_rule(element[r], x)->n, r < 2 ? 4 : 27);
    fem_element_stiffness(element[r], &steel, x, &K[r][0][0]);
    fem_element_mass(element[r], steel.rho, x, &m[r][0][0]);
  }
  assert_memory_equal(K[0], K[1], sizeof K[0]); /* C3D10's stiffness */
  assert_memory_equal(m[0], m[2], sizeof m[0]); /* the exact mass */
  assert_true(memcmp(m[0], m[1], sizeof m[0]) != 0);
  straight_element(x);
  assert_int_equal(fem_element_stiffness_rule(&full, x)->n, 4);
}

/* Eigenvalues of the stiffness, ascending. */
static void eigenvalues(const fem_element *element, const double x[10][3], double value[30]) {
  double       K[30][30], space[30 * 30];
  PetscBLASInt info, n = 30, size = 30 * 30;
  fem_element_stiffness(element, &steel, x, &K[0][0]);
  LAPACKsyev_("N", "U", &n, &K[0][0], &n, value, space, &size, &info);
  assert_int_equal(info, 0);
}

/* Six strains at four points are 24 = 30 - 6: no motion but the rigid ones is without energy. */
static void four_points_leave_only_rigid_motions(void **state) {
  (void)state;
  fem_element reduced, full;
  double      x[10][3], value[30], other[30], least = 1;
  assert_int_equal(fem_element_create(MESH_TET10, FEM_STANDARD, &reduced), 0);
  assert_int_equal(fem_element_create(MESH_TET10, FEM_FULL, &full), 0);
  for (int level = 0; level <= 8; level++) {
    curved_element(.01 * level, x);
    eigenvalues(&reduced, x, value);
    eigenvalues(&full, x, other);
    for (int i = 0; i < 6; i++) check_below(value[i], 1e-13 * value[29], "rigid motion");
    least = fmin(least, value[6] / other[6]);
    assert_true(value[6] > 1e-3 * value[29]);
  }
  print_message("least elastic eigenvalue, 4 points over 27: %.3f\n", least);
  assert_true(least > .7);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tetrahedron_rules_have_their_degree),
      cmocka_unit_test(triangle_rule_is_exact_to_degree_seven),
      cmocka_unit_test(mass_matches_the_closed_form),
      cmocka_unit_test(stiffness_knows_rigid_motions_and_constant_strain),
      cmocka_unit_test(four_points_unless_full),
      cmocka_unit_test(four_points_leave_only_rigid_motions),
  };
  if (PetscInitialize(NULL, NULL, NULL, NULL) != 0) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  PetscFinalize();
  return failures;
}
