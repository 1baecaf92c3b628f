/* Tables as spreadsheets and people write them. */
#include "mesh/table/csv.h"

#include <stdio.h>
#include <string.h>

#include "mesh/table/number.h"
#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

static char path[300];

static shb_status read(const char *text, mesh_table *t) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
  return mesh_table_read(path, true, t);
}

/* The cells of all rows: a|b/c|d. */
static const char *cells_of(const char *text) {
  static char out[512];
  mesh_table  t;
  char       *at = out;
  assert_int_equal(read(text, &t), SHB_OK);
  for (int i = 0; i < t.n_rows; i++)
    for (int k = 0, n = mesh_table_cells(&t, i); k < n; k++)
      at += sprintf(at, "%s%s", k ? "|" : i ? "/" : "", mesh_table_cell(&t, i, k)->text);
  *at = '\0';
  mesh_table_free(&t);
  return out;
}

static void usual_forms_are_read(void **state) {
  (void)state;
  static const char *const table[][2] = {
      {"a,b\n1,2\n", "a|b/1|2"},
      {"\xef\xbb\xbf"
       "1\r\n2\r\n",
       "1/2"},                 /* byte-order mark, CRLF */
      {"1\r2\r", "1/2"},       /* CR */
      {"1;2\n3;4", "1|2/3|4"}, /* no line end */
      {"1,5;2\n", "1,5|2"},    /* commas are decimal ones */
      {"a, b\t1\n", "a, b|1"},
      {"sep=,\r\n1;2,3\r\n", "1;2|3"},
      {"\"a,b\" , \"c\"\"d\"\n\"1\",\"\"\"\"\n", "a,b|c\"d/1|\""},
      {"\"two\nlines\",1\n2,3\n", "two\nlines|1/2|3"},
      {"# a; comment\n\n  \n,,\n1,2,,\n  # b\n3,4\n", "1|2/3|4"},
      {"0.5 1 %  -2\t3\n", "0.5 1 %  -2|3"},
      {"0.5 1 %  -2 .3 Hz\n", "0.5|1 %|-2|.3 Hz"}, /* blanks before numbers */
      {"blade deviation\n1 0.5\n", "blade deviation/1|0.5"},
      {" \"1\"  \"2\" 3\n", "1|2|3"},
      {",1\n", "|1"},
      {"", ""},
      {"\xef\xbb\xbf", ""},
  };
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    assert_string_equal(cells_of(table[i][0]), table[i][1]);
}

static void places_count_lines_and_characters(void **state) {
  (void)state;
  mesh_table t;
  assert_int_equal(read("\xef\xbb\xbf"
                        "\xc3\xa4\xc3\xb6, b\r\n\r\n\"x\ny\" ,\"z\"\n1,2\n",
                        &t),
                   SHB_OK);
  static const int place[3][2][2] = {{{1, 1}, {1, 5}}, {{3, 1}, {4, 5}}, {{5, 1}, {5, 3}}};
  assert_int_equal(t.n_rows, 3);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 2; k++) {
      assert_int_equal(mesh_table_cell(&t, i, k)->line, place[i][k][0]);
      assert_int_equal(mesh_table_cell(&t, i, k)->column, place[i][k][1]);
    }
  assert_true(mesh_table_is_header(&t, 0));
  assert_false(mesh_table_is_header(&t, 2));
  mesh_table_free(&t);
}

static void numbers_come_with_what_stands_behind_them(void **state) {
  (void)state;
  mesh_table  t;
  double      x[4];
  const char *unit[4];
  assert_int_equal(read("-2.385, 1 %,117.25Hz,+.5e-1\n", &t), SHB_OK);
  for (int i = 0; i < 4; i++)
    assert_int_equal(mesh_table_number(&t, 0, i, "a number", &x[i], &unit[i]), SHB_OK);
  assert_true(x[0] == -2.385 && x[1] == 1 && x[2] == 117.25 && x[3] == 0.05);
  assert_string_equal(unit[0], "");
  assert_string_equal(unit[1], "%");
  assert_string_equal(unit[2], "Hz");
  assert_string_equal(unit[3], "");
  mesh_table_free(&t);
}

/* Read the text, and the number of cell 1 of row 1, else of cell 0: one of them fails. */
static void refuses(const char *text, const char *says) {
  mesh_table  t;
  double      x;
  const char *unit, *start = path + strlen(path);
  shb_status  status = read(text, &t);
  if (status == SHB_OK) {
    const int row = t.n_rows > 1, column = mesh_table_cells(&t, row) > 1;
    status = mesh_table_number(&t, row, 0, "a length", &x, &unit);
    if (status == SHB_OK) status = mesh_table_number(&t, row, column, "a length", &x, &unit);
    mesh_table_free(&t);
  }
  assert_int_equal(status, SHB_ERR_INPUT);
  assert_string_equal(shb_message() + (start - path), says);
}

static void faults_are_told_with_their_place(void **state) {
  (void)state;
  refuses("a\n0,05\n", ":2:1: 0,05 has a decimal comma; write 0.05, commas separate columns");
  refuses("a;b\n1;0,05\n", ":2:3: '0,05' has a decimal comma; write it with a point");
  refuses("a;b\n1;0,5 %\n", ":2:3: '0,5 %' has a decimal comma; write it with a point");
  refuses("1,two\n", ":1:3: 'two' is not a number; expected a length");
  refuses("1,\n2,,3\n", ":2:3: '' is not a number; expected a length");
  refuses("nan\n", ":1:1: 'nan' is not a number; expected a length");
  refuses("-inf\n", ":1:1: '-inf' is not a number; expected a length");
  refuses("#N/A\n", ":1:1: '#N/A' is not a number; expected a length");
  refuses("a;b\n#DIV/0!;3\n", ":2:1: '#DIV/0!' is not a number; expected a length");
  refuses("0x10\n", ":1:1: '0x10' is not a number; expected a length");
  refuses("1.234.5\n", ":1:1: '1.234.5' is not a number; expected a length");
  refuses("1e999\n", ":1:1: '1e999' is too large");
  refuses("1,\"2\n3\n", ":1:3: the quote that opens here is not closed");
  refuses("1,\"2\"3\n", ":1:6: text behind a closed quote; a quote within a cell is written twice");
}

static void other_files_are_refused(void **state) {
  (void)state;
  mesh_table t;
  char       expected[400];
  FILE      *file = fopen(path, "wb");
  fwrite(
      "\xff\xfe"
      "1\0\n\0",
      1, 6, file); /* UTF-16 */
  fclose(file);
  assert_int_equal(mesh_table_read(path, true, &t), SHB_ERR_INPUT);
  snprintf(expected, sizeof expected, "%s: holds binary data; a table is text in UTF-8", path);
  assert_string_equal(shb_message(), expected);
  assert_int_equal(mesh_table_read("/dev/zero", true, &t), SHB_ERR_IO);
  assert_string_equal(shb_message(), "/dev/zero: is a pipe or a device, not a file");
  assert_int_equal(mesh_table_read("none.csv", true, &t), SHB_ERR_IO);
  assert_int_equal(mesh_table_read(".", true, &t), SHB_ERR_IO);
}

static void long_tables_are_read(void **state) {
  (void)state;
  enum { ROWS = 100000 };
  mesh_table  t;
  double      x, sum = 0;
  const char *unit;
  FILE       *file = fopen(path, "wb");
  fputs("contact.n0,contact.mu,contact.kv\n", file);
  for (int i = 0; i < ROWS; i++) fprintf(file, "%d,%.6f,\"%d N/m\"\n", i, 0.1 + 1e-6 * i, i);
  fclose(file);
  assert_int_equal(mesh_table_read(path, false, &t), SHB_OK);
  assert_int_equal(t.n_rows, ROWS + 1);
  for (int i = 1; i < t.n_rows; i++) {
    assert_int_equal(mesh_table_line(&t, i), i + 1);
    assert_int_equal(mesh_table_number(&t, i, 2, "", &x, &unit), SHB_OK);
    sum += x;
  }
  assert_true(sum == 0.5 * ROWS * (ROWS - 1.));
  mesh_table_free(&t);
}

static int make(void **state) {
  if (scratch_make(state)) return 1;
  snprintf(path, sizeof path, "%s", scratch("t.csv"));
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(usual_forms_are_read),
                                     cmocka_unit_test(places_count_lines_and_characters),
                                     cmocka_unit_test(numbers_come_with_what_stands_behind_them),
                                     cmocka_unit_test(faults_are_told_with_their_place),
                                     cmocka_unit_test(other_files_are_refused),
                                     cmocka_unit_test(long_tables_are_read)};
  return cmocka_run_group_tests(tests, make, scratch_remove);
}
