/* Contact faces of a sector matched node for node, and faces that do not match. */
#include "mesh/core/face_match.h"

#include "mesh/base/constants.h"
#include "mesh/base/vec3.h"
#include "tests/support/box.h"
#include "tests/support/check.h"

enum { BLADES = 29 };

/* Box coordinates (x, y, z) become axial x, angle (1/2 - y / width) sector, radius 0.4 + z. The
 * right side is y = 0. */
static mesh_fe sector(mesh_kind kind) {
  const double size[3]  = {0.03, 0.05, 0.04};
  const int    cells[3] = {3, 2, 4};
  mesh_fe      mesh;
  assert_ok(kind == MESH_HEX20 ? box_hex(size, cells, &mesh) : box_mesh(size, cells, &mesh));
  assert_ok(box_set(&mesh, MESH_CONTACT_RIGHT, 1, 0));
  assert_ok(box_set(&mesh, MESH_CONTACT_LEFT, 1, size[1]));
  for (int i = 0; i < mesh.n_nodes; i++) {
    double      *x     = mesh.coordinates + 3 * i;
    const double angle = (0.5 - x[1] / size[1]) * SHB_TWO_PI / BLADES, r = 0.4 + x[2];
    x[1] = -r * sin(angle);
    x[2] = r * cos(angle);
  }
  return mesh;
}

static void every_right_node_has_its_left_one(void **state) {
  (void)state;
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    mesh_fe mesh = sector((mesh_kind)kind);
    int     n, *right, *left;
    assert_ok(mesh_fe_match(&mesh, MESH_AXIS_X, BLADES, &n, &right, &left));
    assert_int_equal(n, kind == MESH_HEX20 ? 7 * 9 - 12 : 7 * 9);
    for (int i = 0; i < n; i++) {
      double turned[3];
      mesh_axis_rotate(MESH_AXIS_X, SHB_TWO_PI / BLADES, mesh.coordinates + 3 * left[i], turned);
      assert_near(vec3_distance(turned, mesh.coordinates + 3 * right[i]), 0, 1e-15);
      assert_true(i == 0 || right[i] > right[i - 1]);
    }
    free(right);
    free(left);
    mesh_fe_free(&mesh);
  }
}

static void faces_that_do_not_match_are_told(void **state) {
  (void)state;
  mesh_fe mesh = sector(MESH_TET10);
  int     n, *right, *left;
  double *x = mesh.coordinates + 3 * mesh.set[MESH_CONTACT_LEFT].nodes[0];
  x[0] += 2e-9;
  assert_int_equal(mesh_fe_match(&mesh, MESH_AXIS_X, BLADES, &n, &right, &left), SHB_ERR_INPUT);
  assert_has(shb_message(), "is 2e-09 m from the nearest node");
  mesh.set[MESH_CONTACT_LEFT].n--;
  assert_int_equal(mesh_fe_match(&mesh, MESH_AXIS_X, BLADES, &n, &right, &left), SHB_ERR_INPUT);
  assert_has(shb_message(), "do not match");
  mesh.set[MESH_CONTACT_LEFT].n = 0;
  assert_int_equal(mesh_fe_match(&mesh, MESH_AXIS_X, BLADES, &n, &right, &left), SHB_ERR_INPUT);
  assert_has(shb_message(), "group contact_left is absent or empty");
  mesh_fe_free(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_right_node_has_its_left_one),
                                     cmocka_unit_test(faces_that_do_not_match_are_told)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
