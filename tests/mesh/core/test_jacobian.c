/* Inverted elements found, straightened and told. */
#include "mesh/core/jacobian.h"

#include "tests/support/box.h"
#include "tests/support/check.h"

static mesh_fe box(mesh_kind kind) {
  const double size[3]  = {2, 3, 5};
  const int    cells[3] = {1, 1, 1};
  mesh_fe      mesh;
  assert_ok(kind == MESH_HEX20 ? box_hex(size, cells, &mesh) : box_mesh(size, cells, &mesh));
  return mesh;
}

/* det J is the volume divided by that of the reference element: 30 for the cube, 5 / (1/6) for each
 * of six tetrahedra. */
static void determinants_of_a_brick(void **state) {
  (void)state;
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    mesh_fe mesh = box((mesh_kind)kind);
    for (int e = 0; e < mesh.n_elements; e++) assert_near(mesh_jacobian_least(&mesh, e), 30, 1e-13);
    assert_int_equal(mesh_jacobian_inverted(&mesh), 0);
    assert_ok(mesh_jacobian_check(&mesh, "box"));
    mesh_fe_free(&mesh);
  }
}

static void the_worst_corner_of_a_sheared_brick(void **state) {
  (void)state;
  mesh_fe      mesh = box(MESH_HEX20);
  double       x[3];
  const double angle = 0.4;
  assert_near(mesh_jacobian_worst_corner(&mesh, x), 1, 1e-14);
  for (int i = 0; i < mesh.n_nodes; i++)
    mesh.coordinates[3 * i] += tan(angle) * mesh.coordinates[3 * i + 1];
  assert_near(mesh_jacobian_worst_corner(&mesh, x), cos(angle), 1e-14);
  mesh_fe_free(&mesh);
}

/* A mid-side node beyond the quarter point of its edge inverts the element. */
static void curved_edges_are_straightened(void **state) {
  (void)state;
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    mesh_fe              mesh     = box((mesh_kind)kind);
    const mesh_topology *topology = mesh_topology_of(mesh.kind);
    const int           *node     = mesh.connectivity;
    const int            middle   = node[topology->corners];
    double              *x        = mesh.coordinates + 3 * middle, was[3];
    const double        *a        = mesh.coordinates + 3 * node[topology->edge[0][0]];
    char                *moved    = calloc((size_t)mesh.n_nodes, 1);
    for (int d = 0; d < 3; d++) {
      was[d] = x[d];
      x[d]   = a[d] + 0.4 * (x[d] - a[d]);
    }
    assert_true(mesh_jacobian_inverted(&mesh) > 0);
    assert_int_equal(mesh_jacobian_check(&mesh, "box"), SHB_ERR_INPUT);
    assert_has(shb_message(), "inverted (det J <= 0): element");
    mesh_jacobian_straighten(&mesh, moved);
    assert_int_equal(mesh_jacobian_inverted(&mesh), 0);
    assert_true(moved[middle]);
    for (int d = 0; d < 3; d++) assert_near(x[d], was[d], 1e-15);
    free(moved);
    mesh_fe_free(&mesh);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(determinants_of_a_brick),
                                     cmocka_unit_test(the_worst_corner_of_a_sheared_brick),
                                     cmocka_unit_test(curved_edges_are_straightened)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
