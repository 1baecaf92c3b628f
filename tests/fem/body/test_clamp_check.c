/* Bodies that the clamp holds, and parts that float. */
#include "fem/body/clamp_check.h"

#include "tests/support/box.h"
#include "tests/support/check.h"

static mesh_fe box(void) {
  const double size[3]  = {4, 1, 1};
  const int    cells[3] = {4, 1, 1};
  mesh_fe      mesh;
  assert_ok(box_hex(size, cells, &mesh));
  return mesh;
}

static void one_body_is_held(void **state) {
  (void)state;
  mesh_fe mesh = box();
  int     bodies;
  assert_ok(fem_clamp_check(&mesh, &bodies));
  mesh.set[MESH_ROOT].n = 0;
  assert_int_equal(fem_clamp_check(&mesh, &bodies), SHB_ERR_INPUT);
  assert_has(shb_message(), "4 elements (the first has tag 1)");
  mesh_fe_free(&mesh);
}

/* Without its second element the body falls into the clamped one and two that float. */
static void parts_that_float_are_counted(void **state) {
  (void)state;
  mesh_fe mesh = box();
  int     bodies;
  memmove(mesh.connectivity + 20, mesh.connectivity + 40, 2 * 20 * sizeof(int));
  memmove(mesh.element_tag + 1, mesh.element_tag + 2, 2 * sizeof(long));
  mesh.n_elements = 3;
  assert_int_equal(fem_clamp_check(&mesh, &bodies), SHB_ERR_INPUT);
  assert_has(shb_message(), "2 elements (the first has tag 3) are not connected to group root");
  assert_int_equal(bodies, 2);
  mesh_fe_free(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(one_body_is_held),
                                     cmocka_unit_test(parts_that_float_are_counted)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
