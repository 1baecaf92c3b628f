/* The outcome of a balance as its program tells it: points above the tolerance are no success. */
#include "cases/commands/balance_run.h"

#include <stdio.h>
#include <string.h>

#include "cases/schema/case.h"
#include "modal/hdf5/h5.h"
#include "modal/model/model.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/scratch_folder.h"

static void write_model(void) {
  hid_t          file;
  modal_model    model;
  shb_provenance provenance = {"", "", "", ""};
  random_model(3, WITH_RESIDUAL, 7, &model); /* three pairs end with 31 harmonics */
  assert_ok(h5_create(scratch("three.h5"), &file));
  assert_ok(modal_model_write(file, &model, &provenance));
  assert_ok(h5_close(file));
  modal_model_free(&model);
}

static shb_status run_with(const char *harmonics, const char *tolerance) {
  case_file             file;
  const command_options options = {.quiet = true};
  FILE                 *out     = fopen(scratch("case.yaml"), "w");
  assert_non_null(out);
  fprintf(out,
          "name: three\nmodal: {file: three.h5}\n"
          "contact: {to: ground, psi: 0 deg, phi: 0 deg, mu: 0.4, ku: 0.5, kv: 0.8, n0: 0.3}\n"
          "mhb:\n  frequency: [0.2, 0.22]\n  harmonics: %s\n%s%s\n  search: {starts: 0}\n"
          "  stability: never\n",
          harmonics, *tolerance ? "  tolerance: " : "", tolerance);
  fclose(out);
  assert_ok(case_read(scratch("case.yaml"), CASE_MHB, stderr, &file));
  const shb_status status = balance_run(&file, &options, NULL);
  case_free(&file);
  return status;
}

/* Also where the result is there already. Harmonics that are given have no tolerance. */
static void points_above_the_tolerance_end_a_run_with_code_3(void **state) {
  (void)state;
  write_model();
  for (int i = 0; i < 2; i++) {
    assert_refused(run_with("auto", "1e-8"), SHB_NOT_CONVERGED, "above mhb.tolerance 1e-08");
    assert_non_null(strstr(shb_message(), "harmonics: they are marked"));
    print_message("%s\n", shb_message());
  }
  assert_ok(run_with("auto", "1e-3"));
  assert_ok(run_with("3", ""));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_above_the_tolerance_end_a_run_with_code_3)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
