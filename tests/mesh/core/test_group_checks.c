/* Groups that must have faces, and groups that exclude each other. */
#include "mesh/core/group_checks.h"

#include "tests/support/box.h"
#include "tests/support/check.h"

static mesh_fe box(void) {
  const double size[3]  = {2, 3, 5};
  const int    cells[3] = {2, 2, 2};
  mesh_fe      mesh;
  assert_ok(box_hex(size, cells, &mesh));
  assert_ok(box_set(&mesh, MESH_CONTACT_RIGHT, 1, 0));
  assert_ok(box_set(&mesh, MESH_CONTACT_LEFT, 1, 3));
  return mesh;
}

static void assert_groups_refused(const mesh_fe *mesh, const char *words) {
  assert_int_equal(mesh_fe_check_groups(mesh, "box"), SHB_ERR_INPUT);
  assert_has(shb_message(), words);
}

static void faces_that_meet_along_an_edge_are_allowed(void **state) {
  (void)state;
  mesh_fe mesh = box();
  assert_ok(mesh_fe_check_groups(&mesh, "box"));
  mesh_fe_free(&mesh);
}

static void groups_without_faces_are_refused(void **state) {
  (void)state;
  mesh_fe mesh = box();
  mesh.n_more  = 1;
  snprintf(mesh.more[0], sizeof mesh.more[0], "snubber");
  assert_groups_refused(&mesh, "box: group snubber is absent or empty");
  mesh.set[MESH_ROOT].n = 0;
  assert_groups_refused(&mesh, "box: group root is absent or empty");
  mesh_fe_free(&mesh);
}

static void groups_that_overlap_are_refused(void **state) {
  (void)state;
  mesh_fe mesh = box();
  assert_ok(box_set(&mesh, MESH_CONTACT_LEFT, 0, 0));
  assert_groups_refused(&mesh, "groups contact_left and root share 4 of 4 faces");
  assert_ok(box_set(&mesh, MESH_CONTACT_LEFT, 1, 0));
  assert_groups_refused(&mesh, "groups contact_right and contact_left share 4 of 4 faces");
  assert_ok(box_set(&mesh, MESH_CONTACT_LEFT, 1, 3));
  assert_ok(box_set(&mesh, MESH_LOAD, 0, 0));
  assert_groups_refused(&mesh, "groups load and root share 4 of 4 faces");
  mesh_fe_free(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(faces_that_meet_along_an_edge_are_allowed),
                                     cmocka_unit_test(groups_without_faces_are_refused),
                                     cmocka_unit_test(groups_that_overlap_are_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
