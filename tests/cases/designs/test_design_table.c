/* A table of designs: its cells, and what is wrong with it. */
#include "cases/designs/design_table.h"

#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

static void write_table(const char *text) {
  FILE *file = fopen(scratch("table.csv"), "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

static void check_cells(const char *text) {
  design_table t;
  char         why[512];
  write_table(text);
  assert_true(design_table_read(scratch("table.csv"), &t, why, sizeof why));
  assert_int_equal(t.n_columns, 2);
  assert_int_equal(t.n_rows, 2);
  assert_string_equal(t.column[0], "contact.n0");
  assert_string_equal(t.column[1], "contact.mu");
  assert_string_equal(t.cell[0], "10 N");
  assert_string_equal(t.cell[1], "0.3");
  assert_string_equal(t.cell[2], "12 N");
  assert_string_equal(t.cell[3], "");
  design_table_free(&t);
  assert_null(t.text);
}

static void cells_are_without_blanks(void **state) {
  (void)state;
  check_cells("contact.n0,contact.mu\n10 N,0.3\n12 N,\n");
  check_cells("  contact.n0\t, contact.mu \r\n10 N ,\t0.3\r\n 12 N, ");
}

/* Empty lines are left out, and counted. */
static void lines_are_those_of_the_file(void **state) {
  (void)state;
  design_table t;
  char         why[512];
  write_table("\n  \na\n\n1\n\t\n2\n3");
  assert_true(design_table_read(scratch("table.csv"), &t, why, sizeof why));
  assert_int_equal(t.n_rows, 3);
  assert_int_equal(t.line[0], 5);
  assert_int_equal(t.line[1], 7);
  assert_int_equal(t.line[2], 8);
  assert_string_equal(t.cell[2], "3");
  design_table_free(&t);
}

static void check_refused(const char *text, const char *part) {
  design_table t;
  char         why[512] = "";
  if (text) write_table(text);
  assert_false(
      design_table_read(text ? scratch("table.csv") : scratch("none.csv"), &t, why, sizeof why));
  assert_has(why, part);
  assert_null(strchr(why, '\n'));
  assert_null(t.text);
}

static void faults_are_told_with_their_line(void **state) {
  (void)state;
  check_refused("", "empty");
  check_refused("\n \n", "empty");
  check_refused("a,b\n1,2\n\n3\n", ".csv:4: row 2 has 1 columns, the header has 2");
  check_refused("a,b\n1,2,3\n", "row 1 has 3 columns, the header has 2");
  check_refused("a,b\n1;2\n", "separated by commas");
  check_refused(NULL, "none.csv");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cells_are_without_blanks),
      cmocka_unit_test(lines_are_those_of_the_file),
      cmocka_unit_test(faults_are_told_with_their_line),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
