/* Nodes of the two sides of a sector are paired by the turn to the next blade. Sides that do not
 * match are refused with the distance. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mesh/base/vec3.h"
#include "mesh/core/cyclic_sides.h"
#include "mesh/core/group_checks.h"
#include "tests/support/box.h"
#include "tests/support/fem.h"
#include "tests/support/sector.h"

enum { BLADES = 7 };

static const mesh_axis axis = MESH_AXIS_X;

static int paired(const mesh_fe *mesh) {
  int n = 0;
  for (int i = 0; i < mesh->n_nodes; i++) n += mesh->image[i] >= 0;
  return n;
}

/* Each right node is its partner turned by the sector angle; so is a vector by turn. */
static void check_pairs(const mesh_fe *mesh) {
  for (int i = 0; i < mesh->n_nodes; i++) {
    double turned[3], by_turn[3];
    if (mesh->image[i] < 0) continue;
    const double *left = mesh->coordinates + 3 * mesh->image[i];
    mesh_axis_rotate(axis, SHB_TWO_PI / BLADES, left, turned);
    for (int d = 0; d < 3; d++) by_turn[d] = vec3_dot(mesh->turn[d], left);
    check_below(vec3_distance(turned, mesh->coordinates + 3 * i), 1e-12, "partner");
    check_below(vec3_distance(turned, by_turn), 1e-15, "turn");
    assert_int_equal(mesh->image[mesh->image[i]], -1);
  }
}

static void sides_are_paired(void **state) {
  (void)state;
  mesh_fe           mesh = make_bladed_sector(BLADES, 1);
  mesh_cyclic_sides sides;
  assert_ok(mesh_cyclic_pair(&mesh, axis, BLADES, &sides));
  assert_true(sides.n > 15);
  assert_int_equal(paired(&mesh), sides.n);
  check_below(sides.gap, 1e-12, "gap");
  check_pairs(&mesh);
  const mesh_fe other = mesh_cyclic_alternating(&mesh);
  assert_true(other.turn[1][2] == -mesh.turn[1][2] && other.turn[0][0] == -1);
  mesh_fe_free(&mesh);
}

/* Named the wrong way round, the groups are swapped. */
static void sides_may_be_exchanged(void **state) {
  (void)state;
  mesh_fe             mesh = make_bladed_sector(BLADES, 1);
  mesh_cyclic_sides   sides;
  const mesh_face_set right   = mesh.set[MESH_CYCLIC_RIGHT];
  mesh.set[MESH_CYCLIC_RIGHT] = mesh.set[MESH_CYCLIC_LEFT];
  mesh.set[MESH_CYCLIC_LEFT]  = right;
  assert_ok(mesh_cyclic_pair(&mesh, axis, BLADES, &sides));
  assert_ptr_equal(mesh.set[MESH_CYCLIC_RIGHT].nodes, right.nodes);
  check_pairs(&mesh);
  mesh_fe_free(&mesh);
}

static void without_sides_nothing_changes(void **state) {
  (void)state;
  mesh_fe           mesh        = make_bladed_sector(BLADES, 1);
  mesh_cyclic_sides sides       = {1, 1};
  mesh.set[MESH_CYCLIC_RIGHT].n = mesh.set[MESH_CYCLIC_LEFT].n = 0;
  assert_ok(mesh_cyclic_pair(&mesh, axis, BLADES, &sides));
  assert_int_equal(sides.n, 0);
  assert_null(mesh.image);
  mesh_fe_free(&mesh);
}

static void refused(mesh_fe *mesh, int blades, const char *text) {
  mesh_cyclic_sides sides;
  assert_refused(mesh_cyclic_pair(mesh, axis, blades, &sides), SHB_ERR_INPUT, text);
  assert_null(mesh->image);
}

static void bad_sides(void **state) {
  (void)state;
  mesh_fe   mesh = make_bladed_sector(BLADES, 1);
  const int node = mesh.set[MESH_CYCLIC_RIGHT].nodes[1], n = mesh.set[MESH_CYCLIC_LEFT].n;
  double   *x = mesh.coordinates + 3 * node;
  refused(&mesh, 8,
          "the cyclic sides are 51.4286 deg apart, a sector of 7 blades; rotor.blades is 8");
  refused(&mesh, 0, "rotor.blades: the mesh has cyclic sides");
  x[0] += 1e-4;
  refused(&mesh, BLADES, "1 of 25 nodes of cyclic_right have no partner; node");
  assert_non_null(strstr(shb_message(), "m is 0.0001 m from the nearest node of cyclic_left"));
  x[0] -= 1e-4;
  mesh.set[MESH_CYCLIC_LEFT].n = 1;
  refused(&mesh, BLADES, "nodes of cyclic_right have no partner");
  mesh.set[MESH_CYCLIC_LEFT].n = 0;
  refused(&mesh, BLADES, "group cyclic_left is absent or empty; a sector needs both cyclic sides");
  mesh.set[MESH_CYCLIC_LEFT].n  = n;
  mesh.set[MESH_CYCLIC_RIGHT].n = 1;
  refused(&mesh, BLADES, "cyclic_right has 6 nodes, cyclic_left 25");
  mesh_fe_free(&mesh);
}

/* Part of one side is clamped, of the other not. */
static void a_clamp_reaches_both_sides(void **state) {
  (void)state;
  mesh_fe mesh = make_bladed_sector(BLADES, 1);
  mesh.set[MESH_ROOT].n /= 2;
  refused(&mesh, BLADES, "let group root reach both sides alike");
  mesh_fe_free(&mesh);
}

static void a_node_on_the_axis(void **state) {
  (void)state;
  mesh_fe mesh = make_bladed_sector(BLADES, 1);
  int    *left = mesh.set[MESH_CYCLIC_LEFT].nodes, *right = mesh.set[MESH_CYCLIC_RIGHT].nodes;
  for (int i = 0; i < 6 * mesh.set[MESH_CYCLIC_LEFT].n; i++) { /* both sides share a node */
    const double *x = mesh.coordinates + 3 * right[i];
    for (int k = 0; k < 6 * mesh.set[MESH_CYCLIC_LEFT].n; k++) {
      double turned[3];
      mesh_axis_rotate(axis, SHB_TWO_PI / BLADES, mesh.coordinates + 3 * left[k], turned);
      if (right[0] != right[i] || vec3_distance(turned, x) > 1e-9) continue;
      left[k] = right[i];
    }
  }
  double *x = mesh.coordinates + 3 * right[0];
  x[1] = x[2] = 0;
  refused(&mesh, BLADES, "is on both cyclic sides, on the engine axis; give the disc a bore");
  mesh_fe_free(&mesh);
}

/* Faces of contact or load on a cyclic side are inside the disc. */
static void a_contact_face_on_a_side(void **state) {
  (void)state;
  static const mesh_set_id used[] = {MESH_CONTACT_LEFT, MESH_LOAD};
  static const char *const text[] = {"groups contact_left and cyclic_right share",
                                     "groups load and cyclic_right share"};
  for (int i = 0; i < 2; i++) {
    mesh_fe             mesh = make_bladed_sector(BLADES, 1);
    const mesh_face_set own  = mesh.set[used[i]];
    assert_ok(mesh_fe_check_groups(&mesh, "mesh"));
    mesh.set[used[i]] = mesh.set[MESH_CYCLIC_RIGHT];
    assert_refused(mesh_fe_check_groups(&mesh, "mesh"), SHB_ERR_INPUT, text[i]);
    assert_non_null(strstr(shb_message(), "a cyclic side lies inside the disc"));
    mesh.set[used[i]] = own;
    mesh_fe_free(&mesh);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(sides_are_paired),
                                     cmocka_unit_test(sides_may_be_exchanged),
                                     cmocka_unit_test(without_sides_nothing_changes),
                                     cmocka_unit_test(bad_sides),
                                     cmocka_unit_test(a_clamp_reaches_both_sides),
                                     cmocka_unit_test(a_node_on_the_axis),
                                     cmocka_unit_test(a_contact_face_on_a_side)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
