/* Dakota's parameters and results: both formats, descriptors, gradients, faults. */
#include "cases/study/dakota_files.h"

#include "tests/support/files.h"

static void write_text(const char *text) {
  spill(scratch("in"), text, strlen(text));
}

static void check_parameters(const char *text) {
  dakota_parameters p;
  char              why[256];
  write_text(text);
  assert_true(dakota_read(scratch("in"), &p, why, sizeof why));
  assert_int_equal(p.n_variables, 2);
  assert_string_equal(p.variable[0], "contact__n0");
  assert_near(p.value[0], 12.5, 0);
  assert_near(p.value[1], -3e-3, 0);
  assert_int_equal(p.n_responses, 2);
  assert_string_equal(p.response[0], "peak");
  assert_int_equal(p.active[0], 3);
  assert_int_equal(p.active[1], 1);
  assert_int_equal(p.n_derivatives, 1);
  assert_int_equal(p.derivative[0], 1);
}

static void both_formats_are_read(void **state) {
  (void)state;
  check_parameters(
      "  2 variables\n  1.25e+01 contact__n0\n -3.0e-03 contact__mu\n 2 functions\n"
      " 3 ASV_1:peak\n 1 ASV_2:frequency\n 1 derivative_variables\n 2 DVV_1:contact__mu\n"
      " 0 analysis_components\n 1 eval_id\n");
  check_parameters(
      "{ DAKOTA_VARS = 2 }\n{ contact__n0 = 1.25e+01 }\n{ contact__mu = -3.0e-03 }\n"
      "{ DAKOTA_FNS = 2 }\n{ ASV_1:peak = 3 }\n{ ASV_2:frequency = 1 }\n"
      "{ DAKOTA_DER_VARS = 1 }\n{ DVV_1:contact__mu = 2 }\n{ DAKOTA_EVAL_ID = 1 }\n");
}

static void descriptors_become_paths(void **state) {
  (void)state;
  static const char *const known[][2] = {
      {"contact__n0", "contact.n0"},
      {"mesh__blade__sections__4__thickness", "mesh.blade.sections[4].thickness"},
      {"modes__3__frequency", "modes[3].frequency"},
      {"contact__n0__2", "contact.n0[2]"},
      {"peak_to_peak", "peak_to_peak"},
      {"tip", "tip"}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    char path[2 * DAKOTA_TAG];
    dakota_path(known[i][0], path);
    assert_string_equal(path, known[i][1]);
  }
}

/* Values, then gradients, each where it is active. */
static void results_are_what_is_asked_for(void **state) {
  (void)state;
  const dakota_parameters p           = {.n_responses   = 3,
                                         .response      = {"peak", "frequency", "tip"},
                                         .active        = {3, 1, 2},
                                         .n_derivatives = 2};
  const double            value[3]    = {1.5, -2, 7};
  const double            gradient[6] = {1, 2, 3, 4, 5, 6};
  double                  read[6];
  size_t                  size;
  char                    name[2][32];
  assert_true(dakota_write(scratch("out"), &p, value, gradient));
  char *text = slurp(scratch("out"), &size);
  text[size] = '\0';
  assert_int_equal(sscanf(text, "%lf %31s %lf %31s [ %lf %lf ] [ %lf %lf ]", &read[0], name[0],
                          &read[1], name[1], &read[2], &read[3], &read[4], &read[5]),
                   8);
  assert_string_equal(name[0], "peak");
  assert_string_equal(name[1], "frequency");
  const double wanted[6] = {1.5, -2, 1, 2, 5, 6};
  for (int i = 0; i < 6; i++) assert_near(read[i], wanted[i], 0);
  assert_has_not(text, "tip");
  free(text);
  assert_true(dakota_fail(scratch("out"), "no peak"));
  text       = slurp(scratch("out"), &size);
  text[size] = '\0';
  assert_string_equal(text, "FAIL\nno peak\n");
  free(text);
  assert_false(dakota_write(scratch("none/out"), &p, value, gradient));
}

static void faults_are_told(void **state) {
  (void)state;
  static const char *const faults[][2] = {
      {"", "no parameters file"},
      {"2 variables\n1 a\n", "no parameters file"},
      {"0 variables\n", "expected a whole number from 1 to 64"},
      {"65 variables\n", "expected a whole number from 1 to 64"},
      {"1 variables\nabc a\n1 functions\n", "'abc' is no number"},
      {"1 variables\nnan a\n1 functions\n", "is no number"},
      {"1 variables\n1 a\n1 functions\n1 ASV_1\n", "names no response"},
      {"1 variables\n1 a\n2 functions\n1 ASV_1:peak\n", "2 functions are announced, 1 stand there"},
      {"1 variables\n1 a b\n1 functions\n1 ASV_1:peak\n", "'b' stands behind '1 a'"},
      {"1 variables\n1 a\n1 functions\n1 ASV_2:peak\n", "expected ASV_1:peak"},
      {"1 variables\n1 a\n1 functions\n1 ASV_1:peak\n1 derivative_variables\n1 DVV_1:b\n",
       "1 DVV_1:b: variable 1 is a"},
      {"1 variables\n1 a\n1 functions\n1 ASV_1:peak\n2 DVV_1:a\n",
       "2 DVV_1:a: expected a whole number from 1 to 1"}};
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
    dakota_parameters p;
    char              why[256] = "";
    write_text(faults[i][0]);
    assert_false(dakota_read(scratch("in"), &p, why, sizeof why));
    assert_has(why, faults[i][1]);
    assert_null(strchr(why, '\n'));
  }
  dakota_parameters p;
  char              why[256] = "";
  assert_false(dakota_read(scratch("none"), &p, why, sizeof why));
  assert_has(why, "cannot be opened");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(both_formats_are_read),
      cmocka_unit_test(descriptors_become_paths),
      cmocka_unit_test(results_are_what_is_asked_for),
      cmocka_unit_test(faults_are_told),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
