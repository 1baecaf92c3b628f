/* Deviations of the blades of a ring: random ones and tables. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/mistuning/deviations.h"
#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

enum { MANY = 20000 };

/* Moments of a normal distribution within four standard errors; odd numbers too. */
static void are_normal(void **state) {
  static double x[MANY + 1];
  double        mean = 0, square = 0, fourth = 0;
  (void)state;
  assert_ok(mhb_deviations_random(0.013, 7, 2, MANY + 1, x));
  for (int i = 0; i <= MANY; i++) {
    const double z = x[i] / 0.013;
    mean += z / (MANY + 1);
    square += z * z / (MANY + 1);
    fourth += z * z * z * z / (MANY + 1);
  }
  assert_small(mean, 4 / sqrt(MANY));
  assert_near(square, 1, 4 * sqrt(2. / MANY));
  assert_near(fourth, 3, 4 * sqrt(96. / MANY));
}

static void are_reproducible(void **state) {
  double a[7], b[7], c[7];
  (void)state;
  assert_ok(mhb_deviations_random(0.01, 7, 3, 7, a));
  assert_ok(mhb_deviations_random(0.01, 7, 4, 7, c));
  assert_ok(mhb_deviations_random(0.01, 7, 3, 7, b));
  assert_memory_equal(a, b, sizeof a);
  assert_true(fabs(a[0] - c[0]) > 1e-6 && fabs(a[6] - c[6]) > 1e-6);
  assert_ok(mhb_deviations_random(0.01, 8, 3, 7, c));
  assert_true(fabs(a[0] - c[0]) > 1e-6);
}

static void must_be_above_half(void **state) {
  static double x[MANY];
  (void)state;
  assert_refused(mhb_deviations_random(0.2, 1, 0, MANY, x), SHB_ERR_INPUT, "must be above -50 %");
}

static void write_text(const char *path, const char *text) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

static void come_from_a_table(void **state) {
  double *x;
  int     columns;
  (void)state;
  write_text(scratch("d.csv"), "# a ring\n0.01\n\n-0.5 %\n  3e-3 \n");
  assert_ok(mhb_deviations_read(scratch("d.csv"), 3, 4, &columns, &x));
  assert_int_equal(columns, 1);
  assert_near(x[0], 0.01, 0);
  assert_near(x[1], -0.005, 1e-18);
  assert_near(x[2], 0.003, 0);
  free(x);
  write_text(scratch("d.csv"), "0.01, 0.02\n0.03;0.04\n");
  assert_ok(mhb_deviations_read(scratch("d.csv"), 2, 2, &columns, &x));
  assert_int_equal(columns, 2);
  assert_near(x[3], 0.04, 0);
  free(x);
}

static void refuses(const char *text, const char *part) {
  double *x;
  int     columns;
  write_text(scratch("bad.csv"), text);
  assert_refused(mhb_deviations_read(scratch("bad.csv"), 2, 3, &columns, &x), SHB_ERR_INPUT, part);
}

static void faults_have_their_line(void **state) {
  double *x;
  int     columns;
  (void)state;
  refuses("0.1\n", "1 lines of deviations; expected 2");
  refuses("0.1\n0.2\n0.3\n", "bad.csv:3: more than 2 lines");
  refuses("0.1\n0.2, 0.3\n", "bad.csv:2: 2 numbers; expected one");
  refuses("0.1,0.2,0.3\n0.2\n", "bad.csv:2: 1 numbers, but 3");
  refuses("0.1\nx\n", "bad.csv:2: 'x");
  refuses("0.1\n-50 %\n", "bad.csv:2: a deviation of -0.5");
  refuses("1,2,3,4\n", "bad.csv:1: more than 3 numbers");
  assert_refused(mhb_deviations_read(scratch("none.csv"), 2, 3, &columns, &x), SHB_ERR_IO,
                 "cannot be read");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(are_normal), cmocka_unit_test(are_reproducible),
      cmocka_unit_test(must_be_above_half), cmocka_unit_test(come_from_a_table),
      cmocka_unit_test(faults_have_their_line)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
