/* Which files reach gmsh. It runs what does not begin as a mesh, so no script may reach it. */
#include "mesh/io/msh_check.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/io/read.h"
#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

static const char head[] = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
static const char rest[] = "$Nodes\n0\n$EndNodes\n$Elements\n0\n$EndElements\n";

static const char *file_of(const char *before, const char *first, const char *after) {
  const char *path = scratch("blade.msh");
  FILE       *file = fopen(path, "w");
  assert_non_null(file);
  assert_true(fprintf(file, "%s%s%s", before, first, after) > 0);
  assert_int_equal(fclose(file), 0);
  return path;
}

static void a_mesh_may_begin_with_comments(void **state) {
  (void)state;
  assert_ok(mesh_msh_check(file_of("", head, rest)));
  assert_ok(mesh_msh_check(file_of("$Comments\na blade\n$EndComments\n\n", head, rest)));
}

static void another_file_is_refused(void **state) {
  (void)state;
  assert_refused(mesh_msh_check(file_of("x", head, rest)), SHB_ERR_INPUT, "not a gmsh mesh file");
  assert_refused(mesh_msh_check(file_of("", "$MeshFormat\n3 0 8\n", rest)), SHB_ERR_INPUT,
                 "mesh format 3; 2.2 or 4.1 is needed");
  assert_refused(mesh_msh_check(file_of("", head, "$EndNodes\n")), SHB_ERR_INPUT,
                 "no $EndElements");
  assert_refused(mesh_msh_check(file_of("", head, "$EndElements\n")), SHB_ERR_INPUT,
                 "no $EndNodes");
}

/* gmsh takes a file whose first line is blank for a script: it would write the second file. */
static void no_script_runs(void **state) {
  char    text[512];
  mesh_fe mesh;
  (void)state;
  const char *made = scratch("made");
  snprintf(text, sizeof text, ";\nPrintf(\"run\") > \"%s\";\n// $EndNodes $EndElements\n", made);
  assert_refused(mesh_fe_read(file_of("\n", head, text), NULL, &mesh), SHB_ERR_INPUT,
                 "not a gmsh mesh file");
  assert_int_not_equal(access(made, F_OK), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_mesh_may_begin_with_comments),
      cmocka_unit_test(another_file_is_refused),
      cmocka_unit_test(no_script_runs),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
