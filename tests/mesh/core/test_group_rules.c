/* Groups selected by plane, radius and nearest point on a box. */
#include "mesh/core/group_rules.h"

#include "tests/support/box.h"
#include "tests/support/check.h"

static mesh_fe box(void) {
  const double size[3]  = {2, 3, 5};
  const int    cells[3] = {2, 3, 4};
  mesh_fe      mesh;
  assert_ok(box_hex(size, cells, &mesh));
  return mesh;
}

/* A plane that is given by a normal of any length; a nearest point spreads over its face alone. */
static void planes_and_nearest_points(void **state) {
  (void)state;
  mesh_fe    mesh        = box();
  mesh_rules rules       = {.n_more = 0};
  rules.usual[MESH_ROOT] = (mesh_rule){
      .kind = MESH_RULE_PLANE, .at = {0.7, 3, 1}, .normal = {0, -7, 0}, .tolerance = 1e-6};
  rules.usual[MESH_LOAD] = (mesh_rule){.kind = MESH_RULE_NEAREST, .at = {2.1, 1, 1}};
  assert_ok(mesh_rules_apply(&rules, MESH_AXIS_X, "box", &mesh));
  assert_int_equal(mesh.set[MESH_ROOT].n, 2 * 4);
  assert_int_equal(mesh.set[MESH_LOAD].n, 3 * 4);
  for (int i = 0; i < 8 * mesh.set[MESH_ROOT].n; i++)
    assert_near(mesh.coordinates[3 * mesh.set[MESH_ROOT].nodes[i] + 1], 3, 1e-15);
  for (int i = 0; i < 8 * mesh.set[MESH_LOAD].n; i++)
    assert_near(mesh.coordinates[3 * mesh.set[MESH_LOAD].nodes[i]], 2, 1e-15);
  mesh_fe_free(&mesh);
}

/* Seen along z, only the edge x = 2, y = 0 is at radius 2: no face is. */
static void a_radius_without_a_face_names_the_nearest(void **state) {
  (void)state;
  mesh_fe    mesh        = box();
  mesh_rules rules       = {.n_more = 0};
  rules.usual[MESH_ROOT] = (mesh_rule){.kind = MESH_RULE_RADIUS, .radius = 2, .tolerance = 1e-3};
  assert_int_equal(mesh_rules_apply(&rules, MESH_AXIS_Z, "box", &mesh), SHB_ERR_INPUT);
  assert_has(shb_message(), "box has no face at radius 2 m");
  mesh_fe_free(&mesh);
}

static void rules_without_sense_are_refused(void **state) {
  (void)state;
  mesh_fe    mesh  = box();
  mesh_rules rules = {.n_more = 0};
  mesh_rule *rule  = &rules.usual[MESH_LOAD];
  *rule            = (mesh_rule){.kind = MESH_RULE_PLANE};
  assert_int_equal(mesh_rules_apply(&rules, MESH_AXIS_X, "box", &mesh), SHB_ERR_INPUT);
  assert_has(shb_message(), "mesh.groups.load.normal: has no direction");
  *rule = (mesh_rule){.kind = MESH_RULE_PLANE, .normal = {1, 0, 0}, .tolerance = 0.1};
  assert_int_equal(mesh_rules_apply(&rules, MESH_AXIS_X, "box", &mesh), SHB_ERR_INPUT);
  assert_has(shb_message(), "is too wide");
  *rule = (mesh_rule){.kind = MESH_RULE_NEAREST, .at = {100, 0, 0}};
  assert_int_equal(mesh_rules_apply(&rules, MESH_AXIS_X, "box", &mesh), SHB_ERR_INPUT);
  assert_has(shb_message(), "m off the body of box");
  mesh_fe_free(&mesh);
}

static void names_of_the_file_and_labels(void **state) {
  (void)state;
  mesh_rules rules       = {.n_more = 1, .n_volumes = 1};
  rules.usual[MESH_ROOT] = (mesh_rule){.kind = MESH_RULE_NAME, .name = "clamp"};
  rules.more[0]          = (mesh_named_rule){"snubber", {.kind = MESH_RULE_NAME, .name = "S1"}};
  rules.volume[0] = (mesh_named_rule){"tip", {.kind = MESH_RULE_NEAREST, .at = {0.2, 0, 0.4}}};
  const mesh_names names = mesh_rules_names(&rules, 1e-3), labels = mesh_rules_labels(&rules);
  assert_string_equal(names.set[MESH_ROOT], "clamp");
  assert_null(names.set[MESH_LOAD]);
  assert_string_equal(names.more[0].name, "S1");
  assert_string_equal(names.more[0].label, "snubber");
  assert_true(names.volume[0].near);
  assert_near(names.volume[0].at[2], 400, 1e-12);
  assert_null(labels.set[MESH_ROOT]);
  assert_string_equal(labels.more[0].name, "snubber");
  assert_false(labels.volume[0].near);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(planes_and_nearest_points),
                                     cmocka_unit_test(a_radius_without_a_face_names_the_nearest),
                                     cmocka_unit_test(rules_without_sense_are_refused),
                                     cmocka_unit_test(names_of_the_file_and_labels)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
