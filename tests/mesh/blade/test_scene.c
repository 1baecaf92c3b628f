/* The blade of the shipped case: its size, contact faces and elements. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#include "cases/schema/case.h"
#include "mesh/blade/blade.h"
#include "mesh/core/face_match.h"
#include "mesh/core/fe_mesh.h"
#include "tests/support/read_mesh.h"

static void scene_blade_is_about_six_thousand_nodes(void **state) {
  (void)state;
  case_file file;
  mesh_fe   mesh;
  char      path[] = "/tmp/shb_scene_XXXXXX.msh";
  int       handle = mkstemps(path, 4);
  assert_true(handle >= 0);
  close(handle);
  assert_int_equal(case_read(SCENE, CASE_MESH, stderr, &file), SHB_OK);
  const shb_provenance origin = {.case_path = file.path, .case_text = file.text};
  if (mesh_blade_write(&file.blade, path, &origin, NULL) != SHB_OK) fail_msg("%s", shb_message());
  if (read_mesh(path, &mesh) != SHB_OK) fail_msg("%s", shb_message());
  assert_int_equal(mesh.kind, MESH_HEX20);
  assert_in_range(mesh.n_nodes, 5000, 7000);
  assert_int_equal(mesh_fe_orient(&mesh, file.axis), SHB_OK);
  int pairs = 0, *right = NULL, *left = NULL;
  assert_int_equal(mesh_fe_match(&mesh, file.axis, file.blades, &pairs, &right, &left), SHB_OK);
  assert_true(pairs >= 20);
  for (int s = 0; s <= MESH_LOAD; s++) assert_true(mesh.set[s].n > 0);
  free(right);
  free(left);
  mesh_fe_free(&mesh);
  case_free(&file);
  unlink(path);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(scene_blade_is_about_six_thousand_nodes),
  };
  return cmocka_run_group_tests_name("mesh.scene", tests, NULL, NULL);
}
