/* A mesh file is itself and what it includes. */
#include "mesh/io/source_files.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/publish.h"
#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

static void write_text(const char *name, const char *text) {
  FILE *file = fopen(scratch(name), "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

/* Whether the fingerprint of a file is another one after a change of another file, which is then
 * undone. */
static bool watches(const char *name, const char *other, const char *text, const char *changed) {
  char before[17], after[17], again[17];
  write_text(other, text);
  assert_ok(mesh_source_fingerprint(scratch(name), before));
  write_text(other, changed);
  assert_ok(mesh_source_fingerprint(scratch(name), after));
  write_text(other, text);
  assert_ok(mesh_source_fingerprint(scratch(name), again));
  assert_string_equal(before, again);
  return strcmp(before, after) != 0;
}

static void a_file_that_includes_nothing_has_its_own_fingerprint(void **state) {
  (void)state;
  static const char *const names[] = {"alone.geo", "alone.inp", "alone.msh", "alone.step"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    char own[17], whole[17];
    write_text(names[i], "\"nothing.txt\" *INCLUDE\n");
    assert_ok(shb_fingerprint(scratch(names[i]), own));
    assert_ok(mesh_source_fingerprint(scratch(names[i]), whole));
    assert_string_equal(own, whole);
  }
  char none[17];
  assert_refused(mesh_source_fingerprint(scratch("none.geo"), none), SHB_ERR_IO, "none.geo");
}

static void what_a_script_includes_counts(void **state) {
  (void)state;
  write_text("box.geo",
             "Include \"par.geo\";\nMerge \"part.step\"; // \"lonely\nh = \"a\";\n"
             "Include \"more.txt\";");
  write_text("deep.txt", "w = 1;");
  write_text("more.txt", "Include \"deep.txt\";");
  assert_true(watches("box.geo", "par.geo", "h = 1;", "h = 2;"));
  assert_true(watches("box.geo", "part.step", "ISO-10303-21;", "ISO-10303-22;"));
  assert_true(watches("box.geo", "more.txt", "Include \"deep.txt\";", "Include  \"deep.txt\";"));
  assert_true(watches("box.geo", "deep.txt", "w = 1;", "w = 2;"));
  assert_false(watches("box.geo", "other.geo", "h = 1;", "h = 2;"));
  write_text("par.geo", "Include \"box.geo\";\nInclude \"par.geo\";"); /* in a circle */
  assert_true(watches("box.geo", "deep.txt", "w = 1;", "w = 2;"));
}

/* gmsh takes both kinds of quotes. A file has many names, which would be a list without end. */
static void other_quotes_and_other_names_count_once(void **state) {
  (void)state;
  write_text("quotes.geo",
             "/* don't */ Include 'single.geo'; s = Sprintf('a \"b\"'); // don't\n"
             "Include\n 'next.geo';\n");
  assert_true(watches("quotes.geo", "next.geo", "h = 1;", "h = 2;"));
  assert_true(watches("quotes.geo", "single.geo", "// \"./single.geo\"", "// \"././single.geo\""));
}

static void what_a_deck_includes_counts(void **state) {
  (void)state;
  write_text("deck.inp",
             "*NODE, NSET=ALL\n*include , Input = nodes.nam \r\n"
             "*INCLUDE, INPUT=\"faces.inc\"\n** *INCLUDE, INPUT=comment.inc\n");
  write_text("nodes.nam", "1, 0, 0, 0\n*INCLUDE,INPUT=rest.nam\n");
  write_text("rest.nam", "2, 1, 0, 0\n");
  write_text("faces.inc", "1, S1\n");
  assert_true(watches("deck.inp", "nodes.nam", "1, 0, 0, 0\n*INCLUDE,INPUT=rest.nam\n",
                      "1, 0, 0, 1\n*INCLUDE,INPUT=rest.nam\n"));
  assert_true(watches("deck.inp", "rest.nam", "2, 1, 0, 0\n", "2, 1, 0, 5\n"));
  assert_true(watches("deck.inp", "faces.inc", "1, S1\n", "1, S2\n"));
  assert_false(watches("deck.inp", "comment.inc", "1\n", "2\n"));
  write_text("rows.csv", "1, 0, 0, 0\n");
  write_text("rows.inp", "*NODE, INPUT=rows.csv\n*ELSET, ELSET=e\n1\n");
  assert_true(watches("rows.inp", "rows.csv", "1, 0, 0, 0\n", "1, 0, 0, 1\n"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_file_that_includes_nothing_has_its_own_fingerprint),
      cmocka_unit_test(what_a_script_includes_counts),
      cmocka_unit_test(other_quotes_and_other_names_count_once),
      cmocka_unit_test(what_a_deck_includes_counts)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
