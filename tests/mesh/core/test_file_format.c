/* The kind of a file by its ending. */
#include "mesh/core/file_format.h"

#include <stdbool.h>

#include "tests/support/check.h"

static void endings_are_known_in_any_case(void **state) {
  (void)state;
  const struct {
    const char *path;
    mesh_format format;
    bool        solid;
  } row[] = {{"blade.msh", MESH_FORMAT_MSH, false},     {"a.b/blade.INP", MESH_FORMAT_INP, false},
             {"blade.step", MESH_FORMAT_STEP, true},    {"BLADE.STP", MESH_FORMAT_STEP, true},
             {"blade.brep", MESH_FORMAT_BREP, true},    {"x.msh.geo", MESH_FORMAT_GEO, true},
             {"blade", MESH_FORMAT_UNKNOWN, false},     {".msh", MESH_FORMAT_UNKNOWN, false},
             {"blade.mshx", MESH_FORMAT_UNKNOWN, false}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    assert_int_equal(mesh_format_of(row[i].path), row[i].format);
    assert_int_equal(MESH_FORMAT_IS_SOLID(mesh_format_of(row[i].path)), row[i].solid);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(endings_are_known_in_any_case)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
