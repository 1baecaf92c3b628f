/* Inverted elements found, straightened and told. */
#include "mesh/core/jacobian.h"

#include "mesh/core/inversion.h"

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

static void swap(int *a, int *b) {
  const int was = *a;
  *a            = *b;
  *b            = was;
}

static void assert_cause(mesh_fe *mesh, mesh_inversion cause, const char *words) {
  assert_int_equal(mesh_inversion_of(mesh, 0), cause);
  assert_refused(mesh_jacobian_check(mesh, "box"), SHB_ERR_INPUT, words);
  assert_has(shb_message(), ", about (");
  mesh_fe_free(mesh);
}

/* Every cause of det J <= 0 by a fault of its own. */
static void the_cause_of_an_inverted_element_is_told(void **state) {
  (void)state;
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    mesh_fe   mesh    = box((mesh_kind)kind);
    const int corners = mesh_topology_of(mesh.kind)->corners;
    int      *node    = mesh.connectivity;
    swap(&node[corners + 1], &node[corners + 2]);
    assert_cause(&mesh, MESH_MIDDLE_ORDER, "its middle nodes are in another order: node ");
    mesh                 = box((mesh_kind)kind);
    mesh.connectivity[1] = mesh.connectivity[0];
    assert_cause(&mesh, MESH_REPEATED, " twice; every node of an element must be another one");
    mesh = box((mesh_kind)kind);
    for (int d = 0; d < 3; d++)
      mesh.coordinates[3 * mesh.connectivity[1] + d] =
          mesh.coordinates[3 * mesh.connectivity[0] + d];
    assert_cause(&mesh, MESH_REPEATED, " are at one place; every node needs its own");
    mesh = box((mesh_kind)kind);
    for (int i = 0; i < mesh.n_nodes; i++) mesh.coordinates[3 * i] *= -1;
    assert_cause(&mesh, MESH_MIRRORED, "its corners go round the other way");
    mesh = box((mesh_kind)kind);
    for (int i = 0; i < mesh.n_nodes; i++) { /* along a direction in which no node hides another */
      double *at = mesh.coordinates + 3 * i;
      at[0] += 0.37 * at[2];
      at[1] += 0.21 * at[2];
      at[2] = 2 * at[0] + at[1];
    }
    assert_cause(&mesh, MESH_FLAT, "its corners lie in one plane");
    mesh            = box((mesh_kind)kind);
    double       *x = mesh.coordinates + 3 * mesh.connectivity[corners];
    const double *a = mesh.coordinates + 3 * mesh.connectivity[0];
    for (int d = 0; d < 3; d++) x[d] = a[d] + 0.4 * (x[d] - a[d]);
    assert_cause(&mesh, MESH_CURVED, "its edges are too curved");
  }
  mesh_fe mesh = box(MESH_HEX20);
  swap(&mesh.connectivity[2], &mesh.connectivity[3]);
  assert_cause(&mesh, MESH_FOLDED, "its corners are in another order, or it is folded");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(determinants_of_a_brick),
                                     cmocka_unit_test(the_worst_corner_of_a_sheared_brick),
                                     cmocka_unit_test(curved_edges_are_straightened),
                                     cmocka_unit_test(the_cause_of_an_inverted_element_is_told)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
