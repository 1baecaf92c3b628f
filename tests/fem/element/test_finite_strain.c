/* Large displacements of one element: closed forms, rigid motions, the tangent as derivative. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/element/finite_strain.h"
#include "tests/support/fem.h"

typedef double nodal[MESH_NODES][3];
typedef const double (*fixed)[3];

static fem_element *element;
static int          n, order; /* nodes and dofs of the element */

/* amount 0: an affine element; otherwise all nodes but the first corners are displaced. */
static void make_element(double amount, nodal x) {
  const mesh_topology *topology = mesh_topology_of(element->kind);
  const double side[4][3] = {{.11, .07, -.03}, {1.12, .12, .08}, {.2, .86, -.08}, {.06, .22, 1.4}};
  for (int i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) {
      const double *r = topology->place[i];
      x[i][d]         = side[0][d] + r[0] * side[1][d] + r[1] * side[2][d] + r[2] * side[3][d];
      if (i >= 4) x[i][d] += amount * sin(3.7 * i + 1.9 * d);
    }
}

/* A smooth field of size amount. */
static void make_field(double amount, double phase, nodal u) {
  for (int i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) u[i][d] = amount * sin(2.3 * i + 1.7 * d * d + phase);
}

/* u = F x - x + offset */
static void deform(const double F[3][3], const nodal x, nodal u) {
  for (int i = 0; i < n; i++)
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

static double largest(const double *v, int count) {
  double most = 0;
  for (int i = 0; i < count; i++) most = fmax(most, fabs(v[i]));
  return most;
}

static void tangent_at_rest_is_the_stiffness(void **state) {
  (void)state;
  for (int curved = 0; curved < 2; curved++) {
    nodal  x, u = {{0}}, f;
    double K[FEM_DOFS * FEM_DOFS], T[FEM_DOFS * FEM_DOFS];
    make_element(.04 * curved, x);
    assert_int_equal(fem_element_is_straight(element, (fixed)x), !curved);
    fem_element_stiffness(element, &steel, (fixed)x, K);
    fem_element_tangent(element, &steel, (fixed)x, (fixed)u, T);
    fem_element_force(element, &steel, (fixed)x, (fixed)u, f);
    check_below(largest(&f[0][0], order), 0, "force at rest");
    for (int i = 0; i < order * order; i++)
      check_below(T[i] - K[i], 1e-14 * largest(K, order * order), "tangent at rest");
  }
}

/* A finite rotation gives no strain and rotates the stiffness: K = Q K0 Q^T. */
static void rotation_makes_no_force(void **state) {
  (void)state;
  nodal  x, u, f;
  double Q[3][3], K[FEM_DOFS * FEM_DOFS], T[FEM_DOFS * FEM_DOFS], scale;
  make_rotation(Q);
  make_element(.04, x);
  deform((fixed)Q, (fixed)x, u);
  fem_element_stiffness(element, &steel, (fixed)x, K);
  scale = largest(K, order * order);
  fem_element_force(element, &steel, (fixed)x, (fixed)u, f);
  check_below(largest(&f[0][0], order), 1e-14 * scale, "force of a rotation");
  check_below(fem_element_stress(element, &steel, (fixed)x, (fixed)u), 1e-13 * steel.E, "stress");
  fem_element_tangent(element, &steel, (fixed)x, (fixed)u, T);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
          double turned = 0;
          for (int c = 0; c < 3; c++)
            for (int d = 0; d < 3; d++)
              turned += Q[a][c] * K[(3 * i + c) * order + 3 * j + d] * Q[b][d];
          check_below(T[(3 * i + a) * order + 3 * j + b] - turned, 1e-13 * scale, "turned tangent");
        }
}

/* Stretch s along x, then a rotation. With e = (s^2 - 1)/2, S is E (1 - nu)/((1 + nu)(1 - 2 nu)) e
 * along x and lambda e across; the Cauchy stress is s S_x and S_y / s. Nodal forces are P int g.
 * Their moment about any axis vanishes and their virial is P F^T V. */
static void stretch_matches_the_closed_form(void **state) {
  (void)state;
  const double s = 1.13, e = (s * s - 1) / 2, nu = steel.nu;
  const double lambda = steel.E * nu / ((1 + nu) * (1 - 2 * nu)), mu = steel.E / (2 * (1 + nu));
  const double along = s * (lambda + 2 * mu) * e, across = lambda * e / s;
  double       Q[3][3], F[3][3], turned, virial = 0, volume = 0;
  nodal        x, u, f;
  make_rotation(Q);
  make_element(.03, x);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) F[a][b] = Q[a][b] * (b == 0 ? s : 1);
  deform((fixed)F, (fixed)x, u);
  check_close(fem_element_stress(element, &steel, (fixed)x, (fixed)u), along - across, 1e-12,
              "von Mises stress");
  fem_element_force(element, &steel, (fixed)x, (fixed)u, f);
  const fem_rule *rule = fem_element_stiffness_rule(element, (fixed)x);
  for (int p = 0; p < rule->n; p++) {
    double g[MESH_NODES][3];
    volume += rule->weight[p] * fem_element_gradient(element, rule, p, (fixed)x, g);
  }
  for (int d = 0; d < 3; d++) { /* sum of f . (x + u) = V tr(P F^T) = V J tr(sigma), J = s */
    turned = 0;
    for (int i = 0; i < n; i++) {
      turned += f[i][d];
      virial += f[i][d] * (x[i][d] + u[i][d]);
    }
    check_below(turned, 1e-12 * steel.E, "resultant");
  }
  check_close(virial, volume * s * (along + 2 * across), 1e-12, "virial");
}

/* The force is cubic in the displacement: central differences err by exactly c h^2. */
static void tangent_is_the_derivative_of_the_force(void **state) {
  (void)state;
  nodal  x, u, direction, shifted, forward, backward;
  double K[FEM_DOFS * FEM_DOFS], error[3], slope[FEM_DOFS] = {0};
  make_element(.04, x);
  make_field(.2, .4, u);
  make_field(1, 1.9, direction);
  fem_element_tangent(element, &steel, (fixed)x, (fixed)u, K);
  for (int i = 0; i < order; i++)
    for (int j = 0; j < order; j++) {
      slope[i] += K[i * order + j] * (&direction[0][0])[j];
      assert_true(K[i * order + j] == K[j * order + i]);
    }
  for (int level = 0; level < 3; level++) {
    double h = .1 / (1 << level), difference[FEM_DOFS];
    for (int sign = -1; sign <= 1; sign += 2) {
      for (int i = 0; i < order; i++)
        (&shifted[0][0])[i] = (&u[0][0])[i] + sign * h * (&direction[0][0])[i];
      fem_element_force(element, &steel, (fixed)x, (fixed)shifted, sign < 0 ? backward : forward);
    }
    for (int i = 0; i < order; i++)
      difference[i] = ((&forward[0][0])[i] - (&backward[0][0])[i]) / (2 * h) - slope[i];
    error[level] = largest(difference, order) / largest(slope, order);
  }
  assert_true(error[0] > 1e-3); /* the cubic term is there */
  check_close(error[0] / error[1], 4, 1e-9, "ratio of errors");
  check_close(error[1] / error[2], 4, 1e-9, "ratio of errors");
}

static int tables(mesh_kind kind, fem_rules rules) {
  element = malloc(sizeof *element);
  if (!element || fem_element_create(kind, rules, element) != 0) return -1;
  n     = element->n;
  order = 3 * n;
  return 0;
}

static int tetrahedron(void **state) {
  (void)state;
  return tables(MESH_TET10, FEM_STANDARD);
}

static int full_tetrahedron(void **state) {
  (void)state;
  return tables(MESH_TET10, FEM_FULL);
}

static int reduced_hexahedron(void **state) {
  (void)state;
  return tables(MESH_HEX20, FEM_STANDARD);
}

static int full_hexahedron(void **state) {
  (void)state;
  return tables(MESH_HEX20, FEM_FULL);
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
  int failures = cmocka_run_group_tests_name("tet10, 4", tests, tetrahedron, free_tables);
  failures += cmocka_run_group_tests_name("tet10, 27", tests, full_tetrahedron, free_tables);
  failures += cmocka_run_group_tests_name("hex20, 2x2x2", tests, reduced_hexahedron, free_tables);
  failures += cmocka_run_group_tests_name("hex20, 3x3x3", tests, full_hexahedron, free_tables);
  PetscFinalize();
  return failures;
}
