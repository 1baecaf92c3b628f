/* No script that lies beside a solid or a mesh is run. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/gmsh/api.h"
#include "mesh/gmsh/reading.h"
#include "mesh/io/read.h"
#include "mesh/io/source.h"
#include "tests/support/box.h"
#include "tests/support/read_source.h"
#include "tests/support/scratch_folder.h"

static void put(const char *name, const char *text) {
  FILE *file = fopen(scratch(name), "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

/* A script that shows that it ran, beside a file. */
static void trap(const char *name) {
  char text[700], beside[64];
  snprintf(beside, sizeof beside, "%s.opt", name);
  snprintf(text, sizeof text, "SystemCall \"touch %s\";\nMesh.MeshSizeFactor = 0.5;\n",
           scratch("ran"));
  put(beside, text);
}

static bool sprung(void) {
  return unlink(scratch("ran")) == 0;
}

/* A block of 40 x 20 x 50 mm as a script, and exported. */
static int make_blocks(void **state) {
  if (scratch_make(state) != 0) return 1;
  mesh_session session;
  int          ierr = 0;
  put("block.geo", "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, -10, 300, 40, 20, 50};\n");
  assert_ok(mesh_session_open(&session));
  gmshOpen(scratch("block.geo"), &ierr);
  gmshWrite(scratch("block.step"), &ierr);
  gmshWrite(scratch("block.brep"), &ierr);
  mesh_session_close(&session);
  return ierr;
}

static mesh_source source_of(const char *name) {
  mesh_source source = {.path = scratch(name), .unit = 1e-3, .size = .02, .axis = MESH_AXIS_X};
  source.rules.usual[MESH_ROOT] = (mesh_rule){
      .kind = MESH_RULE_PLANE, .at = {0, 0, .3}, .normal = {0, 0, 1}, .tolerance = 1e-6};
  return source;
}

/* gmsh's own open runs the script: the trap is one. */
static void the_trap_works(void **state) {
  (void)state;
  mesh_session session;
  int          ierr = 0;
  trap("block.step");
  assert_ok(mesh_session_open(&session));
  gmshOpen(scratch("block.step"), &ierr);
  mesh_session_close(&session);
  assert_true(sprung());
}

static void options_beside_a_solid_change_nothing(void **state) {
  (void)state;
  static const char *const name[] = {"block.step", "block.brep"};
  for (int i = 0; i < 2; i++) {
    int nodes[2];
    for (int trapped = 0; trapped < 2; trapped++) {
      mesh_fe     mesh;
      char        beside[600];
      mesh_source source = source_of(name[i]);
      if (trapped) trap(name[i]);
      if (!trapped && mesh_reading_has_options(source.path, beside, sizeof beside)) unlink(beside);
      assert_ok(mesh_source_read(&source, NULL, &mesh));
      nodes[trapped] = mesh.n_nodes;
      mesh_fe_free(&mesh);
    }
    assert_false(sprung());
    assert_int_equal(nodes[0], nodes[1]);
  }
}

/* A mesh with volumes of materials is read by gmsh. */
static void options_beside_a_mesh_are_not_run(void **state) {
  (void)state;
  const double size[3]  = {.2, .04, .02};
  const int    cells[3] = {3, 2, 2};
  mesh_fe      box, mesh;
  mesh_names   names    = {.n_volumes = 1};
  names.volume[0].label = "all";
  names.volume[0].near  = true;
  assert_ok(box_mesh(size, cells, &box));
  assert_ok(box_write(&box, scratch("box.msh")));
  mesh_fe_free(&box);
  trap("box.msh");
  assert_ok(mesh_fe_read(scratch("box.msh"), &names, &mesh));
  assert_int_equal(mesh.n_regions, 1);
  mesh_fe_free(&mesh);
  assert_false(sprung());
}

static void a_script_with_options_beside_it_is_refused(void **state) {
  (void)state;
  trap("block.geo");
  mesh_source source = source_of("block.geo");
  assert_source_refused(&source, "block.geo.opt: gmsh would run this file with ");
  assert_false(sprung());
  trap("block.step");
  put("merge.geo", "a = \"\"; SetFactory(\"OpenCASCADE\"); Merge \"block.step\";\n");
  source = source_of("merge.geo");
  assert_source_refused(&source, "block.step.opt: gmsh would run this file with ");
  assert_false(sprung());
  put("inner.geo", "Merge 'block.step';\n");
  put("outer.geo", "SetFactory(\"OpenCASCADE\"); Include \"inner.geo\";\n");
  source = source_of("outer.geo");
  assert_source_refused(&source, "block.step.opt: gmsh would run this file with ");
  assert_false(sprung());
  put("computed.geo", "SetFactory(\"OpenCASCADE\"); Merge StrCat(\"block\", \".step\");\n");
  source = source_of("computed.geo");
  assert_source_refused(&source,
                        "computed.geo: gmsh ran a file of options beside a file that the "
                        "script merges (Info: Reading '");
  sprung();
}

/* Neither the home of the user nor the folder of work has a file that gmsh reads. */
static void options_of_the_user_are_not_read(void **state) {
  (void)state;
  static const char *const name[] = {".gmshrc", ".gmsh-options", "gmshrc", "default.opt"};
  char                     text[700], folder[1024];
  snprintf(text, sizeof text, "SystemCall \"touch %s\";\n", scratch("ran"));
  for (size_t i = 0; i < sizeof name / sizeof *name; i++) put(name[i], text);
  assert_non_null(getcwd(folder, sizeof folder));
  setenv("HOME", scratch_folder, 1);
  setenv("GMSH_HOME", scratch_folder, 1);
  assert_int_equal(chdir(scratch_folder), 0);
  mesh_fe     mesh;
  mesh_source source = source_of("block.step");
  assert_ok(mesh_source_read(&source, NULL, &mesh));
  mesh_fe_free(&mesh);
  assert_int_equal(chdir(folder), 0);
  assert_false(sprung());
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_trap_works),
      cmocka_unit_test(options_beside_a_solid_change_nothing),
      cmocka_unit_test(options_beside_a_mesh_are_not_run),
      cmocka_unit_test(a_script_with_options_beside_it_is_refused),
      cmocka_unit_test(options_of_the_user_are_not_read),
  };
  return cmocka_run_group_tests(tests, make_blocks, scratch_remove);
}
