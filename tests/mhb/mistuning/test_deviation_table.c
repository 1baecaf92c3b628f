/* Deviations and frequencies of the blades of a ring from tables. */
#include "mhb/mistuning/deviation_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

static const char *written(const char *text) {
  const char *path = scratch("d.csv");
  FILE       *file = fopen(path, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
  return path;
}

typedef struct {
  const char *text;
  int         blades, n_modes, columns;
  double      value[4];
} form;

static void gives(const form *f, bool hz, double mean) {
  const mhb_deviation_table table = {written(f->text), hz, mean, f->blades, f->n_modes};
  double                   *x;
  int                       columns;
  assert_ok(mhb_deviation_table_read(&table, &columns, &x));
  assert_int_equal(columns, f->columns);
  for (int i = 0; i < f->blades * columns; i++) assert_near(x[i], f->value[i], 1e-15);
  free(x);
}

static void usual_forms_are_read(void **state) {
  (void)state;
  static const form forms[] = {
      {"# a ring\n0.01\n\n-0.5 %\n  3e-3 \n", 3, 4, 1, {0.01, -0.005, 0.003}},
      {"0.01, 0.02\n0.03,0.04\n", 2, 2, 2, {0.01, 0.02, 0.03, 0.04}},
      {"0.01 2 %\n0.03 0.04\n", 2, 2, 2, {0.01, 0.02, 0.03, 0.04}},
      {"0.01;0.02\r\n0.03;0.04;\r\n", 2, 0, 2, {0.01, 0.02, 0.03, 0.04}},
      {"\xef\xbb\xbf-0.01\r\n0.004\r\n", 2, 3, 1, {-0.01, 0.004}},
      {"deviation\n\"0.01\"\n\"-1 %\"\n", 2, 3, 1, {0.01, -0.01}},
      {"blade,deviation\n1,-0.01\n2,0.004\n", 2, 3, 1, {-0.01, 0.004}},
      {"\xef\xbb\xbf"
       "Blade No.\tmode 1\tmode 2\n1\t0.03\t0.04\n0\t0.01\t0.02\n",
       2,
       2,
       2,
       {0.01, 0.02, 0.03, 0.04}},
      {"blade deviations\n0.01\n1\n", 2, 3, 1, {0.01, 1}},
  };
  for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) gives(&forms[i], false, 0);
}

static void frequencies_are_over_their_mean(void **state) {
  (void)state;
  gives(&(form){"116\n118 Hz\n", 2, 3, 1, {-1. / 117, 1. / 117}}, true, 0);
  gives(&(form){"116\n118\n", 2, 3, 1, {116 / 116.5 - 1, 118 / 116.5 - 1}}, true, 116.5);
  gives(&(form){"blade;f1 [Hz];f2 [Hz]\n2;118;406\n1;116;402\n",
                2,
                2,
                2,
                {-1. / 117, -2. / 404, 1. / 117, 2. / 404}},
        true, 0);
}

/* Numbers of blades count from 0 or 1, whatever their column is called. */
static void a_column_that_counts_numbers_the_blades(void **state) {
  (void)state;
  static const double d[] = {0.01, -0.02, 0.03};
  gives(&(form){"Schaufel;d\n1;0.01\n2;-0.02\n3;0.03\n", 3, 0, 1, {d[0], d[1], d[2]}}, false, 0);
  gives(&(form){"0,0.01\n1,-0.02\n2,0.03\n", 3, 0, 1, {d[0], d[1], d[2]}}, false, 0);
}

/* Two blades, three modes; or three blades, modes not known. */
static void refuses_of(const char *text, bool hz, int blades, int modes, const char *says) {
  const mhb_deviation_table table = {written(text), hz, 0, blades, modes};
  double                   *x;
  int                       columns;
  assert_int_equal(mhb_deviation_table_read(&table, &columns, &x), SHB_ERR_INPUT);
  assert_string_equal(strstr(shb_message(), "d.csv") + 5, says);
}

static void refuses(const char *text, bool hz, const char *says) {
  refuses_of(text, hz, 2, 3, says);
}

/* Decimal commas make whole numbers, two by two. An error of a spreadsheet is no comment, and nan
 * no name of a column. */
static void what_a_spreadsheet_leaves_is_told(void **state) {
  (void)state;
  refuses_of("0,1\n-0,1\n0,5\n", false, 3, 0,
             ":3:3: a deviation of 5 (500 %) must be above -50 % and at most 100 %; decimals have "
             "a point");
  refuses_of("115,83\n117,4\n116,51\n", true, 3, 0,
             ":2:5: a deviation of -0.913043 (-91.3043 %) must be above -50 % and at most 100 %; "
             "decimals have a point");
  refuses_of("#N/A\n0.01\n0.02\n", false, 3, 0,
             ":1:1: '#N/A' is not a number; expected a deviation such as 0.01 or 1 %");
  refuses_of("nan\n0.01\n0.02\n", false, 3, 0,
             ":1:1: 'nan' is not a number; expected a deviation such as 0.01 or 1 %");
}

static void faults_have_their_place(void **state) {
  (void)state;
  double *x;
  int     columns;
  refuses("0.1\n", false, ": 1 lines of numbers; expected 2, one a blade (rotor.blades)");
  refuses("d\n0.1\n", false,
          ": 1 lines of numbers below a line of names; expected 2, one a blade (rotor.blades)");
  refuses("", false, ": 0 lines of numbers; expected 2, one a blade (rotor.blades)");
  refuses("0.1\n0.2\n0.3\n", false, ":3: more than 2 lines; expected one a blade (rotor.blades)");
  refuses("0.1\n0.2;0.3\n", false,
          ":2: 2 numbers; expected one for all modes, or one for each of the 3 modes; decimals "
          "have a point, and numbers of blades a line of names above them");
  refuses("0.1,0.2,0.3\n0.2\n", false, ":2: 1 numbers, but 3 in the lines before");
  refuses("1,2,3,4\n1,2,3,4\n", false,
          ":1: 4 numbers; expected one for all modes, or one for each of the 3 modes");
  refuses("1;0.1\n2;0.2\n", false,
          ":1: 2 numbers; expected one for all modes, or one for each of the 3 modes; decimals "
          "have a point, and numbers of blades a line of names above them");
  refuses("0.1\nx\n", false, ":2:1: 'x' is not a number; expected a deviation such as 0.01 or 1 %");
  refuses("0.1\n-50 %\n", false,
          ":2:1: a deviation of -0.5 (-50 %) must be above -50 % and at most 100 %; frequencies in "
          "Hz: rotor.mistuning: {file: NAME, unit: Hz}");
  refuses(
      "115.83\n117.468\n", false,
      ":1:1: a deviation of 115.83 (11583 %) must be above -50 % and at most 100 %; frequencies "
      "in Hz: rotor.mistuning: {file: NAME, unit: Hz}");
  refuses("115.83 Hz\n117.468 Hz\n", false,
          ":1:1: '115.83 Hz' is not a deviation such as 0.01 or 1 %; frequencies in Hz: "
          "rotor.mistuning: {file: NAME, unit: Hz}");
  refuses("0,01\n-0,02\n", false,
          ":1:1: 0,01 has a decimal comma; write 0.01, commas separate columns");
  refuses("0,5\n0,25\n", false,
          ":1: 2 numbers; expected one for all modes, or one for each of the 3 modes; decimals "
          "have a point, and numbers of blades a line of names above them");
  refuses("0.5\n0,25\n", false,
          ":2: 2 numbers; expected one for all modes, or one for each of the 3 modes; decimals "
          "have a point, and numbers of blades a line of names above them");
  refuses("blade;d\n1;0,01\n2;0,02\n", false,
          ":2:3: '0,01' has a decimal comma; write it with a point");
  refuses("blade,d\n1,0.01\n1,0.02\n", false, ":3: blade 1 is in line 2 already");
  refuses("blade,d\n0,0.01\n2,0.02\n", false, ":3: blade 2 of 2; they count from 0 or from 1");
  refuses("blade,d\n1,0.01\nx,0.02\n", false,
          ":3:1: 'x' is not a number; expected the number of a blade");
  refuses("blade,d\n1,0.01\n1.5,0.02\n", false,
          ":3: '1.5' is not the number of a blade; expected 1 to 2");
  refuses("blade,d\n1,0.01\n2\n", false, ":3: no number behind that of the blade");
  refuses("117\n118 rpm\n", true, ":2:1: '118 rpm' is not in Hz (rotor.mistuning.unit)");
  refuses("117\n-118\n", true, ":2:1: a frequency of -118 Hz must be above 0");
  refuses("117\n1\n", true,
          ":2:1: a deviation of -0.983051 (-98.3051 %) must be above -50 % and at most 100 %");
  const mhb_deviation_table none = {scratch("none.csv"), false, 0, 2, 3};
  assert_int_equal(mhb_deviation_table_read(&none, &columns, &x), SHB_ERR_IO);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(usual_forms_are_read),
                                     cmocka_unit_test(frequencies_are_over_their_mean),
                                     cmocka_unit_test(a_column_that_counts_numbers_the_blades),
                                     cmocka_unit_test(faults_have_their_place),
                                     cmocka_unit_test(what_a_spreadsheet_leaves_is_told)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
