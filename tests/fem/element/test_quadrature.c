/* Quadrature rules integrate monomials exactly up to their degree, and no further. */
#include "fem/element/quadrature.h"

#include "tests/support/check.h"

/* Of a sum of up to 64 terms of size 1 at most. */
#define ROUNDING 5e-15

static double factorial(int n) {
  return n < 2 ? 1 : n * factorial(n - 1);
}

/* Integral of r^i s^j t^k over the unit tetrahedron or the unit cube. */
static double exact(mesh_kind kind, int i, int j, int k) {
  if (kind == MESH_HEX20) return 1. / ((i + 1) * (j + 1) * (k + 1));
  return factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3);
}

/* Coordinates of a point of the rule, from its shape functions. */
static double sum_monomial(mesh_kind kind, const fem_rule *rule, int i, int j, int k) {
  const mesh_topology *topology = mesh_topology_of(kind);
  double               sum      = 0;
  for (int p = 0; p < rule->n; p++) {
    double x[3] = {0};
    for (int n = 0; n < topology->nodes; n++)
      for (int d = 0; d < 3; d++) x[d] += rule->shape[p][n] * topology->place[n][d];
    sum += rule->weight[p] * pow(x[0], i) * pow(x[1], j) * pow(x[2], k);
  }
  return sum;
}

/* Largest error of the monomials of total degree (tetrahedra) or degree a direction (hexahedra). */
static double worst(mesh_kind kind, const fem_rule *rule, int degree) {
  double error = 0;
  for (int i = 0; i <= degree; i++)
    for (int j = 0; j <= degree; j++)
      for (int k = 0; k <= degree; k++) {
        if (kind == MESH_TET10 && i + j + k > degree) continue;
        error = fmax(error, fabs(sum_monomial(kind, rule, i, j, k) - exact(kind, i, j, k)));
      }
  return error;
}

static void volumes_are_exact_to_the_degree(void **state) {
  (void)state;
  fem_rule rule;
  fem_tet_rule_4(&rule);
  assert_near(worst(MESH_TET10, &rule, 2), 0, 1e-16);
  assert_true(worst(MESH_TET10, &rule, 3) > 1e-4);
  for (int n = 1; n <= 4; n++) {
    assert_int_equal(fem_tet_rule_conical(n, &rule), 0);
    assert_int_equal(rule.n, n * n * n);
    assert_near(worst(MESH_TET10, &rule, 2 * n - 1), 0, ROUNDING);
    assert_true(worst(MESH_TET10, &rule, 2 * n) > 1e-8);
    assert_int_equal(fem_hex_rule(n, &rule), 0);
    assert_near(worst(MESH_HEX20, &rule, 2 * n - 1), 0, ROUNDING);
    assert_true(worst(MESH_HEX20, &rule, 2 * n) > 1e-8);
  }
}

/* Shape functions of every rule add up to one, their gradients to zero. */
static void faces_are_exact_to_degree_seven(void **state) {
  (void)state;
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    static const double place[2][8][2] = {
        {{0, 0}, {1, 0}, {0, 1}, {.5, 0}, {.5, .5}, {0, .5}},
        {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {.5, 0}, {1, .5}, {.5, 1}, {0, .5}}};
    fem_face_rule rule;
    assert_int_equal(fem_face_rule_create((mesh_kind)kind, &rule), 0);
    for (int i = 0; i <= 7; i++)
      for (int j = 0; j <= (kind == MESH_HEX20 ? 7 : 7 - i); j++) {
        double sum = 0;
        for (int p = 0; p < rule.n; p++) {
          double x[2] = {0}, one = 0, slope[2] = {0};
          for (int n = 0; n < rule.nodes; n++) {
            one += rule.shape[p][n];
            for (int d = 0; d < 2; d++) {
              x[d] += rule.shape[p][n] * place[kind == MESH_HEX20][n][d];
              slope[d] += rule.gradient[p][n][d];
            }
          }
          assert_near(one, 1, 1e-14);
          assert_near(fabs(slope[0]) + fabs(slope[1]), 0, 1e-14);
          sum += rule.weight[p] * pow(x[0], i) * pow(x[1], j);
        }
        const double wanted = kind == MESH_HEX20
                                  ? 1. / ((i + 1) * (j + 1))
                                  : factorial(i) * factorial(j) / factorial(i + j + 2);
        assert_near(sum, wanted, ROUNDING);
      }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(volumes_are_exact_to_the_degree),
                                     cmocka_unit_test(faces_are_exact_to_degree_seven)};
  if (PetscInitialize(NULL, NULL, NULL, NULL)) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  PetscFinalize();
  return failures;
}
