/* Contact faces paired node for node, or projected: exact where the elements are, else third
 * order. */
#include "mesh/core/face_pairing.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "tests/support/box.h"

enum { BLADES = 23 };

static const double size[3] = {.04, .05, .06}, inner = .3;

/* A sector about x between two radial planes.
 *   skew  moves the nodes of the left side within it, not at its rim, so that the nodes differ
 *   lift  rad, rotates the left side off its plane */
static mesh_fe make_sector(mesh_kind kind, int n, double skew, double lift) {
  const int cells[3] = {n, 2, n};
  mesh_fe   mesh;
  assert_int_equal(kind == MESH_HEX20 ? box_hex(size, cells, &mesh) : box_mesh(size, cells, &mesh),
                   SHB_OK);
  assert_int_equal(box_set(&mesh, MESH_CONTACT_LEFT, 1, 0), SHB_OK);
  assert_int_equal(box_set(&mesh, MESH_CONTACT_RIGHT, 1, size[1]), SHB_OK);
  for (int i = 0; i < mesh.n_nodes; i++) {
    double *x = mesh.coordinates + 3 * i, share = x[1] / size[1];
    double  angle = -SHB_TWO_PI / BLADES * (.5 - share), r = inner + x[2];
    if (share == 0) {
      double bump = skew * sin(SHB_PI * x[0] / size[0]) * sin(SHB_PI * x[2] / size[2]);
      x[0] += bump * size[0];
      r += .7 * bump * size[2];
      angle += lift;
    }
    x[1] = -r * sin(angle);
    x[2] = r * cos(angle);
  }
  int   *swap = mesh.set[MESH_CONTACT_LEFT].nodes, m = mesh.set[MESH_CONTACT_LEFT].n;
  double tangential = mesh.coordinates[3 * mesh.set[MESH_CONTACT_RIGHT].nodes[0] + 1];
  if (tangential > 0) { /* y < 0 is the tangential side */
    mesh.set[MESH_CONTACT_LEFT]  = mesh.set[MESH_CONTACT_RIGHT];
    mesh.set[MESH_CONTACT_RIGHT] = (mesh_face_set){m, swap};
  }
  return mesh;
}

/* A field on the face in its own coordinates (axial, radius); kind 0 is quadratic. */
static double field(int kind, double x, double r) {
  double a = x / size[0], b = (r - inner) / size[2];
  return kind == 0 ? 2 + a - 3 * b : sin(2 * a + .3) * cos(3 * b - .2);
}

/* Largest error at the right nodes of the field interpolated from the left ones. */
static double error_of(const mesh_fe *mesh, const mesh_pairing *pairing, int kind) {
  double worst = 0;
  for (int i = 0; i < pairing->n; i++) {
    const double *x   = mesh->coordinates + 3 * pairing->right[i];
    double        sum = 0;
    for (int e = pairing->start[i]; e < pairing->start[i + 1]; e++) {
      const double *y = mesh->coordinates + 3 * pairing->left[e];
      sum += pairing->share[e] * field(kind, y[0], hypot(y[1], y[2]));
    }
    worst = fmax(worst, fabs(sum - field(kind, x[0], hypot(x[1], x[2]))));
  }
  return worst;
}

static void check_sums(const mesh_pairing *pairing) {
  for (int i = 0; i < pairing->n; i++) {
    double sum = 0;
    for (int e = pairing->start[i]; e < pairing->start[i + 1]; e++) sum += pairing->share[e];
    assert_true(fabs(sum - 1) < 1e-13);
    assert_true(i == 0 || pairing->right[i] > pairing->right[i - 1]);
  }
}

static void paired(const mesh_fe *mesh, mesh_pairing *pairing) {
  if (mesh_pairing_create(mesh, MESH_AXIS_X, BLADES, pairing) != SHB_OK)
    fail_msg("%s", shb_message());
  check_sums(pairing);
}

static void equal_faces_are_paired_node_for_node(void **state) {
  (void)state;
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    mesh_fe      mesh = make_sector((mesh_kind)kind, 3, 0, 0);
    mesh_pairing pairing;
    paired(&mesh, &pairing);
    assert_false(pairing.projected);
    assert_int_equal(pairing.start[pairing.n], pairing.n);
    assert_true(pairing.gap == 0 && error_of(&mesh, &pairing, 1) < 1e-12);
    mesh_pairing_free(&pairing);
    mesh_fe_free(&mesh);
  }
}

/* The map is isoparametric: fields linear in position are exact on any face, others of third
 * order. */
static void projection_is_of_third_order(void **state) {
  (void)state;
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    double error[3];
    for (int i = 0; i < 3; i++) {
      mesh_fe      mesh = make_sector((mesh_kind)kind, 4 << i, .06, 0);
      mesh_pairing pairing;
      paired(&mesh, &pairing);
      assert_true(pairing.projected);
      assert_true(pairing.gap < 1e-12);
      assert_true(error_of(&mesh, &pairing, 0) < 1e-11);
      error[i] = error_of(&mesh, &pairing, 1);
      mesh_pairing_free(&pairing);
      mesh_fe_free(&mesh);
    }
    print_message("%s: errors %.2e %.2e %.2e\n", mesh_topology_of((mesh_kind)kind)->name, error[0],
                  error[1], error[2]);
    assert_true(error[0] > 1e-6); /* the error is above rounding */
    for (int i = 0; i < 2; i++) assert_true(log2(error[i] / error[i + 1]) > 2.5);
  }
}

/* A gap of 0.5 % of the face is accepted and reported; one of 5 % is refused. */
static void distance_decides(void **state) {
  (void)state;
  const double far  = .05 * .05;
  mesh_fe      mesh = make_sector(MESH_TET10, 4, 0, 1e-3);
  mesh_pairing pairing;
  paired(&mesh, &pairing);
  assert_true(pairing.projected);
  assert_true(fabs(pairing.gap / (1e-3 * (inner + size[2])) - 1) < 1e-2);
  mesh_pairing_free(&pairing);
  mesh_fe_free(&mesh);
  mesh = make_sector(MESH_TET10, 4, 0, far / inner);
  assert_int_equal(mesh_pairing_create(&mesh, MESH_AXIS_X, BLADES, &pairing), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "contact faces do not match: node "));
  assert_non_null(strstr(shb_message(), "at most 0.00098 m is allowed"));
  assert_null(strchr(shb_message(), '\n'));
  mesh.set[MESH_CONTACT_LEFT].n = 0;
  assert_int_equal(mesh_pairing_create(&mesh, MESH_AXIS_X, BLADES, &pairing), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "contact_left is absent"));
  mesh_fe_free(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(equal_faces_are_paired_node_for_node),
      cmocka_unit_test(projection_is_of_third_order),
      cmocka_unit_test(distance_decides),
  };
  return cmocka_run_group_tests_name("mesh.pairing", tests, NULL, NULL);
}
