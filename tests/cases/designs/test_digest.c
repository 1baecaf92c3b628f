/* Digests: equal for equal inputs, different where an input of the outputs is. */
#include "cases/designs/digest.h"

#include "cases/schema/case.h"
#include "tests/support/study_file.h"

/* Digests of modes and design of the complete case with a replacement, for one output. */
typedef struct {
  char modes[DIGEST_TEXT], design[DIGEST_TEXT];
} digests;

static digests of(const char *from, const char *to, const char *inputs, study_quantity quantity) {
  study_output out  = {.quantity = quantity};
  char        *text = scratch_case(from, to), path[SCRATCH_PATH + 16];
  case_file    file;
  digests      d;
  snprintf(out.name, sizeof out.name, "output %d", quantity);
  scratch_write(study_folder, "one.yaml", text, strlen(text));
  free(text);
  snprintf(path, sizeof path, "%s/one.yaml", study_folder);
  assert_ok(case_read(path, CASE_MESH | CASE_MODAL | CASE_MHB | CASE_POST, stderr, &file));
  digest_modes(&file, inputs, d.modes);
  digest_design(&file, inputs, 1, &out, d.design);
  case_free(&file);
  return d;
}

static void equal_inputs_have_equal_digests(void **state) {
  (void)state;
  const digests a = of(NULL, NULL, "x\n", STUDY_PEAK), b = of(NULL, NULL, "x\n", STUDY_PEAK);
  assert_string_equal(a.modes, b.modes);
  assert_string_equal(a.design, b.design);
  assert_string_not_equal(a.modes, a.design);
  assert_int_equal(strspn(a.design, "0123456789abcdef"), DIGEST_TEXT - 1);
}

/* A key of the contact changes the design and not the modes; one of the modes and a file both. */
static void each_input_changes_what_depends_on_it(void **state) {
  (void)state;
  const digests a       = of(NULL, NULL, "x\n", STUDY_PEAK);
  const digests contact = of("mu: 0.31", "mu: 0.32", "x\n", STUDY_PEAK);
  const digests modes   = of("nu: 0.29", "nu: 0.28", "x\n", STUDY_PEAK);
  const digests file    = of(NULL, NULL, "y\n", STUDY_PEAK);
  const digests output  = of(NULL, NULL, "x\n", STUDY_FREQUENCY);
  assert_string_equal(contact.modes, a.modes);
  assert_string_not_equal(contact.design, a.design);
  assert_string_not_equal(modes.modes, a.modes);
  assert_string_not_equal(modes.design, a.design);
  assert_string_not_equal(file.modes, a.modes);
  assert_string_not_equal(file.design, a.design);
  assert_string_equal(output.modes, a.modes);
  assert_string_not_equal(output.design, a.design);
}

/* Without files there is nothing to fingerprint; a file's content counts, a missing one is told. */
static void files_are_fingerprinted(void **state) {
  (void)state;
  char      path[SCRATCH_PATH + 16], *inputs, *again;
  case_file file = {0};
  assert_ok(digest_inputs(&file, &inputs));
  assert_string_equal(inputs, "");
  free(inputs);
  snprintf(path, sizeof path, "%s/mesh.inp", study_folder);
  scratch_write(study_folder, "mesh.inp", "one", 3);
  file.mesh_file = path;
  assert_ok(digest_inputs(&file, &inputs));
  scratch_write(study_folder, "mesh.inp", "two", 3);
  assert_ok(digest_inputs(&file, &again));
  assert_int_equal(strlen(inputs), 17);
  assert_string_not_equal(inputs, again);
  free(inputs);
  free(again);
  file.mesh_file = (char *)"/nowhere/mesh.inp";
  assert_int_equal(digest_inputs(&file, &inputs), SHB_ERR_IO);
  free(inputs);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(equal_inputs_have_equal_digests),
      cmocka_unit_test(each_input_changes_what_depends_on_it),
      cmocka_unit_test(files_are_fingerprinted),
  };
  return cmocka_run_group_tests(tests, study_folder_make, study_folder_remove);
}
