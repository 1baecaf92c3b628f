/* A steady pressure that follows the surface: its force, its stiffness and its effect on a body. */
#include "fem/body/pressure.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <lapacke.h>

#include "fem/body/equilibrium.h"
#include "fem/body/stress.h"
#include "fem/body/tangent.h"
#include "tests/support/box.h"
#include "tests/support/fem.h"

enum { MOST = 3 * MESH_FACE_NODES };

static fem_element *element;

/* A face of the element somewhere in space, well deformed. */
static int make_face(fem_face_rule *rule, double x[MESH_FACE_NODES][3]) {
  const double size[3] = {.3, .2, .1};
  const int    one[3]  = {1, 1, 1};
  mesh_fe      mesh    = make_box(size, one);
  assert_int_equal(box_set(&mesh, MESH_LOAD, 2, size[2]), SHB_OK);
  assert_int_equal(fem_face_rule_create(mesh.kind, rule), 0);
  for (int i = 0; i < rule->nodes; i++)
    for (int d = 0; d < 3; d++)
      x[i][d] = mesh.coordinates[3 * mesh.set[MESH_LOAD].nodes[i] + d] + .03 * sin(7 * i + 3 * d);
  mesh_fe_free(&mesh);
  return 3 * rule->nodes;
}

/* The stiffness is the symmetric part of the force's derivative. The force is quadratic in x, so
 * central differences are exact but for rounding. On a face with an edge the skew part is not
 * zero. */
static void stiffness_is_the_symmetric_derivative(void **state) {
  (void)state;
  const double  p = 2.385e6, h = 1e-3;
  double        x[MESH_FACE_NODES][3], K[MOST * MOST], D[MOST][MOST], most = 0, skew = 0, error = 0;
  double        f[2][MESH_FACE_NODES][3];
  fem_face_rule rule;
  const int     n = make_face(&rule, x);
  fem_face_pressure_stiffness(&rule, p, (const double(*)[3])x, K);
  for (int j = 0; j < n; j++) {
    double kept = x[j / 3][j % 3];
    for (int s = 0; s < 2; s++) {
      x[j / 3][j % 3] = kept + (s ? h : -h);
      fem_face_pressure(&rule, p, (const double(*)[3])x, f[s]);
    }
    x[j / 3][j % 3] = kept;
    for (int i = 0; i < n; i++) D[i][j] = -(f[1][i / 3][i % 3] - f[0][i / 3][i % 3]) / (2 * h);
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      most  = fmax(most, fabs(D[i][j]));
      skew  = fmax(skew, fabs(D[i][j] - D[j][i]) / 2);
      error = fmax(error, fabs(K[i * n + j] - (D[i][j] + D[j][i]) / 2));
    }
  check_below(error, 1e-11 * most, "stiffness and differences");
  assert_true(skew > .01 * most);
}

/* With pressure on all faces but the clamped one, the edge of the surface is fixed and the
 * stiffness is symmetric. K is then the derivative of the residual; central differences err by c
 * h^2. */
static void tangent_is_exact_with_a_clamped_edge(void **state) {
  (void)state;
  const double   size[3]  = {.21, .13, .08};
  const int      cells[3] = {3, 2, 1};
  mesh_fe        mesh     = make_box(size, cells);
  mesh_face_set *load     = &mesh.set[MESH_LOAD];
  const int      width    = mesh_topology_of(mesh.kind)->face_nodes;
  int           *all = NULL, n = 0;
  for (int side = 1; side < 6; side++) { /* x = size and both faces across y and z */
    assert_int_equal(box_set(&mesh, MESH_LOAD, side / 2, side % 2 ? size[side / 2] : 0), SHB_OK);
    all = realloc(all, (size_t)(width * (n + load->n)) * sizeof *all);
    assert_non_null(all);
    memcpy(all + width * n, load->nodes, (size_t)(width * load->n) * sizeof *all);
    n += load->n;
  }
  free(load->nodes);
  *load               = (mesh_face_set){n, all};
  const fem_body body = {&mesh, &steel, element, {MESH_AXIS_Y, 9000}, 3e9};
  const size_t   dofs = 3 * (size_t)mesh.n_nodes;
  double *u = calloc(dofs, sizeof *u), *d = calloc(dofs, sizeof *d), *v = calloc(dofs, sizeof *v);
  double  error[2], norm, energy;
  fem_system   system;
  Vec          direction, slope, R[2];
  PetscScalar *value;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
  MatCreateVecs(system.K, &direction, &slope);
  for (int s = 0; s < 2; s++) VecDuplicate(slope, &R[s]);
  VecGetArray(direction, &value);
  for (size_t i = 0; i < dofs; i++) {
    if (system.row[i / 3] < 0) continue;
    u[i] = .004 * sin(31 * mesh.coordinates[i] + (double)(i % 3));
    d[i] = value[3 * system.row[i / 3] + (int)(i % 3)] =
        cos(17 * mesh.coordinates[i] + (double)(i % 3));
  }
  VecRestoreArray(direction, &value);
  assert_int_equal(fem_tangent_assemble(&body, u, &system), 0);
  MatMult(system.K, direction, slope);
  VecDot(direction, slope, &energy);
  check_close(tangent_energy(&body, u, d), energy, 1e-11, "energy");
  VecNorm(slope, NORM_INFINITY, &norm);
  for (int level = 0; level < 2; level++) {
    double h = .002 / (1 << level);
    for (int s = 0; s < 2; s++) {
      for (size_t i = 0; i < dofs; i++) v[i] = u[i] + (s ? h : -h) * d[i];
      assert_int_equal(fem_residual_assemble(&body, &system, v, R[s]), 0);
    }
    VecAXPY(R[1], -1, R[0]);
    VecAYPX(R[1], 1 / (2 * h), slope);
    VecAXPY(R[1], -2, slope);
    VecNorm(R[1], NORM_INFINITY, &error[level]);
    error[level] /= norm;
  }
  assert_true(error[0] > 1e-6);
  check_close(error[0] / error[1], 4, 1e-4, "ratio of errors");
  for (int s = 0; s < 2; s++) VecDestroy(&R[s]);
  VecDestroy(&direction), VecDestroy(&slope);
  fem_system_destroy(&system);
  free(u), free(d), free(v);
  mesh_fe_free(&mesh);
}

/* ------------------------------------------------------------------ a strip under pressure */

static const double length = 1, width = .05;

/* Free end of an inextensible cantilever under a force q a length that stays normal to it. From the
 * free end back, t = length - s, in axes with the tangent there along x:
 *   theta' = -M/EI, M' = cos(theta) Fy - sin(theta) Fx, F' = q (-sin(theta), cos(theta)),
 *   r' = -(cos, sin)(theta), all 0 at t = 0.
 * The result is rotated so that the tangent at the clamp is along x. Classical Runge-Kutta rule. */
static void rates(double q, double EI, const double z[6], double k[6]) {
  double c = cos(z[0]), s = sin(z[0]);
  k[0] = -z[1] / EI;
  k[1] = c * z[3] - s * z[2];
  k[2] = -q * s;
  k[3] = q * c;
  k[4] = -c;
  k[5] = -s;
}

static void strip(double q, double EI, double *x, double *y) {
  enum { STEPS = 4000 };
  double z[6] = {0}, h = length / STEPS;
  for (int step = 0; step < STEPS; step++) {
    double k[4][6], w[6];
    rates(q, EI, z, k[0]);
    for (int stage = 1; stage < 4; stage++) {
      for (int i = 0; i < 6; i++) w[i] = z[i] + (stage == 3 ? h : h / 2) * k[stage - 1][i];
      rates(q, EI, w, k[stage]);
    }
    for (int i = 0; i < 6; i++) z[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
  }
  double c = cos(z[0]), s = sin(z[0]);
  *x = -c * z[4] - s * z[5];
  *y = s * z[4] - c * z[5];
}

/* Middle of the tip against the elastica's, relative to the length; clamp force against the
 * pressure. */
static double strip_error(double thickness) {
  const fem_material cork    = {.E = 2.1e11, .rho = 7850};
  const double       size[3] = {length, width, thickness}, tip[3] = {length, 0, thickness / 2};
  const int          cells[3] = {24, 1, 1};
  const double       EI = cork.E * width * pow(thickness, 3) / 12, q = 2 * EI;
  mesh_fe            mesh = make_box(size, cells);
  double             x, y, load[3], sum[3] = {0};
  assert_int_equal(box_set(&mesh, MESH_LOAD, 2, 0), SHB_OK);
  const fem_body  body = {&mesh, &cork, element, {MESH_AXIS_X, 0}, q / width};
  fem_system      system;
  fem_equilibrium at;
  double(*force)[3] = calloc((size_t)mesh.n_nodes, sizeof *force);
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &cork, FEM_FULL, &system), 0);
  assert_int_equal(fem_equilibrium_solve(&body, &system, NULL, &at), 0);
  const double *u = at.displacement + 3 * mesh_fe_nearest(&mesh, tip);
  strip(q, EI, &x, &y);
  print_message(
      "tip of the strip at (%.5f, %.5f), elastica (%.5f, %.5f); %d steps, %d iterations\n",
      length + u[0], u[2], x, y, at.steps, at.iterations);
  assert_int_equal(fem_unbalanced_forces(&body, at.displacement, force, load), 0);
  for (int i = 0; i < mesh.n_nodes; i++)
    for (int d = 0; d < 3 && system.row[i] < 0; d++) sum[d] += force[i][d];
  for (int d = 0; d < 3; d++)
    check_below(sum[d] + load[d], 1e-7 * fabs(load[2]), "reaction and pressure");
  double error = hypot(length + u[0] - x, u[2] - y);
  free(force);
  fem_equilibrium_free(&at);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
  return error;
}

/* A strip bent far with nu = 0 follows the elastica with a normal load, which neglects
 * thickness. */
static void strip_bends_as_the_elastica(void **state) {
  (void)state;
  double error[2] = {strip_error(.02), strip_error(.01)};
  print_message("off by %.2e, %.2e\n", error[0], error[1]);
  check_below(error[0], 6e-4, "tip of the strip");
  check_below(error[1], 1.2e-4, "tip of the thinner strip");
}

/* ------------------------------------------------------------------ eigenvalues */

/* K and M as dense matrices, [n][n]. */
static void dense(Mat A, int n, double *to) {
  Vec                x, y;
  PetscScalar       *in;
  const PetscScalar *out;
  MatCreateVecs(A, &x, &y);
  for (int j = 0; j < n; j++) {
    VecZeroEntries(x);
    VecGetArray(x, &in);
    in[j] = 1;
    VecRestoreArray(x, &in);
    MatMult(A, x, y);
    VecGetArrayRead(y, &out);
    for (int i = 0; i < n; i++) to[i * n + j] = out[i];
    VecRestoreArrayRead(y, &out);
  }
  VecDestroy(&x), VecDestroy(&y);
}

/* A += the whole load stiffness at rest, by differences (exact, as the force is quadratic). */
static void add_whole_stiffness(const fem_body *body, const fem_system *system, int n, double *A) {
  const mesh_face_set *set = &body->mesh->set[MESH_LOAD];
  fem_face_rule        rule;
  assert_int_equal(fem_face_rule_create(body->mesh->kind, &rule), 0);
  for (int face = 0; face < set->n; face++) {
    const int *node = set->nodes + rule.nodes * face;
    double     x[MESH_FACE_NODES][3], f[2][MESH_FACE_NODES][3], h = 1e-3;
    for (int i = 0; i < 3 * rule.nodes; i++)
      x[i / 3][i % 3] = body->mesh->coordinates[3 * node[i / 3] + i % 3];
    for (int j = 0; j < 3 * rule.nodes; j++) {
      double kept = x[j / 3][j % 3];
      for (int s = 0; s < 2; s++) {
        x[j / 3][j % 3] = kept + (s ? h : -h);
        fem_face_pressure(&rule, body->pressure, (const double(*)[3])x, f[s]);
      }
      x[j / 3][j % 3] = kept;
      PetscInt column = system->row[node[j / 3]];
      for (int i = 0; column >= 0 && i < 3 * rule.nodes; i++) {
        PetscInt row = system->row[node[i / 3]];
        if (row < 0) continue;
        A[(3 * row + i % 3) * n + 3 * column + j % 3] -=
            (f[1][i / 3][i % 3] - f[0][i / 3][i % 3]) / (2 * h);
      }
    }
  }
}

/* Lowest eigenvalues of A x = lambda M x, which are real here. */
static void lowest(int n, double *A, double *M, int wanted, double *value) {
  double *re = malloc(3 * (size_t)n * sizeof *re), *im = re + n, *below = im + n;
  assert_int_equal(
      LAPACKE_dggev(LAPACK_ROW_MAJOR, 'N', 'N', n, A, n, M, n, re, im, below, NULL, 1, NULL, 1), 0);
  for (int k = 0; k < wanted; k++) {
    value[k] = INFINITY;
    for (int i = 0; i < n; i++) {
      double here = re[i] / below[i];
      if (here < value[k] && (k == 0 || here > value[k - 1] * (1 + 1e-6))) value[k] = here;
    }
  }
  free(re);
}

/* Eigenvalues with the symmetric part of the load stiffness differ from those with all of it by the
 * square of the pressure. The pressure itself moves them in proportion. */
static void what_is_left_out_counts_twice(void **state) {
  (void)state;
  enum { WANTED = 3 };
  const double size[3]  = {.2, .03, .02};
  const int    cells[3] = {4, 1, 1};
  double       left_out[2], moved[2], rest[WANTED] = {0};
  mesh_fe      mesh = make_box(size, cells);
  fem_system   system;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_FULL, &system), 0);
  const int n = 3 * (int)system.n_free;
  double   *K = malloc(3 * (size_t)(n * n) * sizeof *K), *A = K + n * n, *M = A + n * n;
  for (int level = -1; level < 2; level++) {
    double         p    = level < 0 ? 0 : 5e7 / (1 << level), some[WANTED], all[WANTED];
    const fem_body body = {&mesh, &steel, element, {MESH_AXIS_X, 0}, p};
    double        *none = calloc(3 * (size_t)mesh.n_nodes, sizeof *none);
    fem_body       bare = body;
    assert_int_equal(fem_tangent_assemble(&body, none, &system), 0);
    dense(system.K, n, K), dense(system.M, n, M);
    lowest(n, K, M, WANTED, some);
    bare.pressure = 0;
    assert_int_equal(fem_tangent_assemble(&bare, none, &system), 0);
    dense(system.K, n, A), dense(system.M, n, M);
    add_whole_stiffness(&body, &system, n, A);
    lowest(n, A, M, WANTED, all);
    free(none);
    if (level < 0) memcpy(rest, all, sizeof rest);
    for (int k = 0; level >= 0 && k < 1; k++) {
      left_out[level] = fabs(some[k] / all[k] - 1);
      moved[level]    = fabs(all[k] / rest[k] - 1);
    }
  }
  print_message("pressure moves the first eigenvalue by %.2e, %.2e; left out %.2e, %.2e\n",
                moved[0], moved[1], left_out[0], left_out[1]);
  assert_true(left_out[0] > 1e-5);
  check_close(left_out[0] / left_out[1], 4, .05, "second order of what is left out");
  check_close(moved[0] / moved[1], 2, .1, "first order of the pressure");
  free(K);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

static int tables(void **state) {
  (void)state;
  element = make_element_tables(FEM_FULL);
  return element == NULL;
}

static int free_tables(void **state) {
  (void)state;
  free(element);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(stiffness_is_the_symmetric_derivative),
                                     cmocka_unit_test(tangent_is_exact_with_a_clamped_edge),
                                     cmocka_unit_test(strip_bends_as_the_elastica),
                                     cmocka_unit_test(what_is_left_out_counts_twice)};
  if (PetscInitialize(NULL, NULL, NULL, NULL)) return 1;
  int failures = run_with_both_elements(tests, tables, free_tables);
  PetscFinalize();
  return failures;
}
