/* Hexahedra with zero-energy modes are found in columns, and nowhere else. */
#include "fem/element/hourglass.h"

#include "tests/support/box.h"
#include "tests/support/check.h"

static shb_status check(int nx, int ny, int nz, mesh_kind kind) {
  const double size[3]  = {1, 1, 1};
  const int    cells[3] = {nx, ny, nz};
  mesh_fe      mesh;
  assert_ok(kind == MESH_HEX20 ? box_hex(size, cells, &mesh) : box_mesh(size, cells, &mesh));
  const shb_status status = fem_hourglass_check(&mesh);
  mesh_fe_free(&mesh);
  return status;
}

static void columns_are_refused(void **state) {
  (void)state;
  assert_int_equal(check(4, 1, 1, MESH_HEX20), SHB_ERR_INPUT);
  assert_has(shb_message(), "4 hexahedra (the first has tag 1)");
  assert_int_equal(check(1, 1, 1, MESH_HEX20), SHB_ERR_INPUT);
}

static void two_elements_across_pass(void **state) {
  (void)state;
  assert_ok(check(4, 2, 1, MESH_HEX20));
  assert_ok(check(3, 2, 2, MESH_HEX20));
  assert_ok(check(4, 1, 1, MESH_TET10));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(columns_are_refused),
                                     cmocka_unit_test(two_elements_across_pass)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
