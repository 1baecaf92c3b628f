#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cases/schema/motion.h"
#include "tests/support/scratch.h"

static shb_status read_text(const char *text, case_motion *motion, char **said) {
  char   folder[SCRATCH_PATH], path[2 * SCRATCH_PATH];
  size_t size = 0;
  scratch_create(folder);
  scratch_write(folder, "m.yaml", text, strlen(text));
  snprintf(path, sizeof path, "%s/m.yaml", folder);
  FILE      *errors = open_memstream(said, &size);
  shb_status status = case_motion_read(path, NULL, errors, motion);
  fclose(errors);
  scratch_remove(folder);
  return status;
}

static void reads_signals(void **state) {
  (void)state;
  char       *said;
  case_motion m;
  assert_int_equal(read_text("contact: {mu: 0.4, ku: 1 MN/m, kv: 0.5 MN/m, n0: 100 N, to: ground}\n"
                             "motion:\n"
                             "  v: [[3 um, 0 deg], [100 um, 30 deg]]\n"
                             "  u: [0, [200 um, -90 deg], [7 um, 180 deg]]\n"
                             "  w: []\n",
                             &m, &said),
                   SHB_OK);
  assert_string_equal(said, "");
  assert_true(m.contact.mu == 0.4 && m.contact.ku[0] == 1e6 && m.contact.ku[1] == 0);
  assert_true(m.contact.kv == 5e5 && m.contact.n_preloads == 1 && m.contact.n0[0] == 100);
  assert_int_equal(m.contact.preload, MHB_EQUILIBRIUM);
  assert_true(m.contact.tolerance == 1e-13); /* tighter than a case's */
  assert_int_equal(m.n_harmonics, 2);
  const double complex expected[9] = {
      3e-6, 1e-4 * (sqrt(3) / 2 + I / 2), 0, 0, -2e-4 * I, -7e-6, 0, 0, 0};
  for (int i = 0; i < 9; i++) assert_true(cabs(m.motion[i] - expected[i]) < 1e-19);
  case_motion_free(&m);
  free(said);
}

static void takes_accuracy(void **state) {
  (void)state;
  char       *said;
  case_motion m;
  assert_int_equal(read_text("contact: {mu: 0.4, ku: 1, kv: 1, n0: 1, accuracy: fast}\n"
                             "motion: {v: [], u: [], w: []}\n",
                             &m, &said),
                   SHB_OK);
  assert_true(m.contact.tolerance == 1e-3);
  case_motion_free(&m);
  free(said);
}

static void tells_faults(void **state) {
  (void)state;
  char       *said;
  case_motion m;
  assert_int_equal(read_text("contact: {mu: 0.4, ku: 1 MN/m, n0: [1 N, 2 N]}\n"
                             "motion:\n"
                             "  v: [[3 um, 0 deg], [100 Hz, 30 deg], 3 deg]\n"
                             "  u: 3\n",
                             &m, &said),
                   SHB_ERR_INPUT);
  assert_non_null(
      strstr(said, "m.yaml:1:1: error: contact.kv: missing; expected a number in N/m\n"));
  assert_non_null(strstr(said,
                         "m.yaml:1:36: error: contact.n0: is a list; a prescribed motion takes one "
                         "number\n"));
  assert_non_null(
      strstr(said,
             "m.yaml:2:1: error: motion.w: missing; expected a list of [amplitude, phase] in "
             "m\n"));
  assert_non_null(
      strstr(said, "m.yaml:3:23: error: motion.v[1][0]: '100 Hz' has unit Hz, expected m\n"));
  assert_non_null(
      strstr(said, "m.yaml:3:40: error: motion.v[2]: '3 deg' has unit deg, expected m\n"));
  assert_non_null(strstr(said,
                         "m.yaml:4:6: error: motion.u: is a single value; expected a list of "
                         "[amplitude, phase] in m\n"));
  assert_non_null(strstr(said, "\n6 errors\n"));
  assert_null(m.motion);
  free(said);
  assert_int_equal(read_text("mesh: {}\n", &m, &said), SHB_ERR_INPUT);
  assert_non_null(strstr(said, "mesh: unknown key; known here: contact, motion\n"));
  free(said);
}

static void too_many_harmonics(void **state) {
  (void)state;
  char text[4096] = "contact: {mu: 0.4, ku: 1, kv: 1, n0: 1}\nmotion: {u: [], w: [], v: [0", *said;
  for (int i = 0; i < CASE_MAX_MOTION + 1; i++) strcat(text, ",1");
  strcat(text, "]}\n");
  case_motion m;
  assert_int_equal(read_text(text, &m, &said), SHB_ERR_INPUT);
  assert_non_null(strstr(said, "motion.v: has harmonics to 201; at most 200"));
  free(said);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(reads_signals), cmocka_unit_test(takes_accuracy),
      cmocka_unit_test(tells_faults), cmocka_unit_test(too_many_harmonics)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
