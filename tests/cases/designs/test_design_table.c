/* A table of designs: its keys, its values in SI, and what is wrong with it. */
#include "cases/designs/design_table.h"

#include <stdlib.h>

#include "tests/support/scratch_folder.h"
#include "tests/support/study_text.h"

/* Designs of a table [n][keys.n]; fault: part of the message of a table that is refused. */
static double *read_table(const char *table, const char *fault, study_keys *keys, int *n) {
  FILE *file = fopen(scratch("table.csv"), "w");
  assert_non_null(file);
  fputs(table, file);
  fclose(file);
  study_text t      = study_text_parse("plan: table.csv\n");
  double    *design = NULL;
  *keys             = (study_keys){0};
  design_table_read(&t.issues, t.root, scratch("table.csv"), keys, n, &design);
  study_text_check(&t, fault);
  study_text_free(&t);
  return design;
}

static void check_values(const char *table) {
  study_keys keys;
  int        n;
  double    *design = read_table(table, NULL, &keys, &n);
  assert_int_equal(keys.n, 2);
  assert_int_equal(n, 2);
  assert_string_equal(keys.key[0].path, "contact.n0");
  assert_string_equal(keys.key[1].path, "contact.mu");
  const double wanted[] = {10, 0.3, 1200, 0.4};
  for (int i = 0; i < 4; i++) assert_within(design[i], wanted[i], 1e-15);
  free(design);
  study_keys_free(&keys);
}

static void values_are_in_si_whoever_wrote_the_table(void **state) {
  (void)state;
  check_values("contact.n0,contact.mu\n10 N,0.3\n1.2 kN,0.4\n");
  check_values("  contact.n0 , contact.mu \r\n\r\n10 N ,  0.3\r\n 1.2 kN, 0.4");
  check_values("\xef\xbb\xbf\"contact.n0\";\"contact.mu\"\n\"10 N\";0.3\n1.2 kN;0.4\n");
}

static void check_refused(const char *table, const char *part) {
  study_keys keys;
  int        n;
  double    *design = read_table(table, part, &keys, &n);
  assert_null(design);
  study_keys_free(&keys);
}

static void faults_are_told_with_their_line(void **state) {
  (void)state;
  check_refused("", "the table is empty");
  check_refused("1,2\n3,4\n", "must name the varied keys");
  check_refused("contact.n0,\n1,2\n", "column 2 has no name");
  check_refused("contact.n0,contact.n0\n1,2\n", "is the column 1 and 2");
  check_refused("contact.n0,contact.mu\n1 N,0.3\n2 N\n", "table.csv:3");
  check_refused("contact.n0,contact.mu\n1 N,0,3\n", "a decimal point");
  check_refused("contact.n0,contact.mu\n1 m,0.3\n", "table.csv:2");
  check_refused("contact.nothing\n1\n", "contact.nothing");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values_are_in_si_whoever_wrote_the_table),
      cmocka_unit_test(faults_are_told_with_their_line),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
