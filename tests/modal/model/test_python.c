/* The modal file between programs: h5py writes and we read; we write and h5py and h5dump read.
 *
 * Arguments: python, tests/modal/model/foreign.py, cases/bring_your_own/write_modal.py. Exit code
 * 77 without h5py. */
#include <math.h>

#include "mesh/base/constants.h"
#include "modal/model/model.h"
#include "tests/support/files.h"

static const char *python, *foreign, *example;

static bool run(const char *format, const char *a, const char *b, const char *c) {
  char command[2048];
  snprintf(command, sizeof command, format, a, b, c);
  return system(command) == 0;
}

/* The example's structure: its modes must give back M = I, K and F. */
static void test_example(void **state) {
  (void)state;
  static const double K[3][3] = {{1, 0.2, 0.1}, {0.2, 1.3, 0.15}, {0.1, 0.15, 1.6}};
  static const double F[3] = {0.04, 0.06, 0.03}, omega[3] = {0.94827, 1.13815, 1.30591};
  modal_model         model;
  assert_true(run("cd '%s' && '%s' '%s'", scratch_folder, python, example));
  assert_ok(modal_model_read(scratch("three_degree.modal.h5"), &model));
  assert_int_equal(model.n_modes, 3);
  assert_int_equal(model.n_pairs, 1);
  assert_int_equal(model.n_load, 1);
  assert_int_equal(model.n_probes, 1);
  assert_false(model.has_left);
  assert_string_equal(model.probe_name[0], "mass");
  for (int i = 0; i < 3; i++) {
    double w = SHB_TWO_PI * model.frequency[i];
    assert_true(fabs(w - omega[i]) < 1e-5 && fabs(model.damping_ratio[i] - 0.01 * w) < 1e-14);
    assert_true(model.modal_force[i] == 0);
  }
  for (int a = 0; a < 3; a++) {
    double complex force = 0;
    for (int i = 0; i < 3; i++) force += model.right[3 * a + i] * model.modal_force[3 + i];
    assert_true(cabs(force - F[a]) < 1e-14);
    for (int b = 0; b < 3; b++) {
      double mass = 0, stiffness = 0;
      for (int i = 0; i < 3; i++) {
        double w       = SHB_TWO_PI * model.frequency[i];
        double product = model.right[3 * a + i] * model.probe[3 * b + i];
        mass += product;
        stiffness += product * w * w;
      }
      assert_true(fabs(mass - (a == b)) < 1e-14 && fabs(stiffness - K[a][b]) < 1e-13);
    }
  }
  modal_model_free(&model);
}

static void test_others_types(void **state) {
  (void)state;
  modal_model model;
  assert_true(run("'%s' '%s' write '%s'", python, foreign, scratch("foreign.h5")));
  assert_ok(modal_model_read(scratch("foreign.h5"), &model));
  assert_int_equal(model.n_modes, 4);
  assert_int_equal(model.n_load, 2);
  assert_true(model.has_left);
  for (int i = 0; i < 4; i++)
    assert_true(model.frequency[i] == 100 * (i + 1) && model.damping_ratio[i] == 0.25);
  for (int i = 0; i < 24; i++)
    assert_true(model.right[i] == i && model.left[i] == -i && model.probe[i] == i);
  for (int i = 0; i < 12; i++) assert_true(model.modal_force[i] == i + I * (12 + i));
  assert_string_equal(model.probe_name[0], "tip");
  assert_string_equal(model.probe_name[1], "psi \xcf\x88");
  modal_model_free(&model);
}

static void write_ours(void) {
  static double               frequency[] = {100, 200}, damping[] = {0.01, 0};
  static double               shape[] = {1, 2, 3, 4, 5, 6};
  static double complex       force[] = {0, 0, 1.5, 2.5 - 0.125 * I};
  static char                 name[] = "tip \xcf\x88", *names[] = {name};
  static const shb_provenance from  = {"case.yaml", "name: \xcf\x88\n", "modes = 2\n", "test"};
  const modal_model           model = {.n_modes       = 2,
                                       .n_pairs       = 1,
                                       .n_probes      = 1,
                                       .n_load        = 1,
                                       .frequency     = frequency,
                                       .damping_ratio = damping,
                                       .right         = shape,
                                       .modal_force   = force,
                                       .probe_name    = names,
                                       .probe         = shape};
  hid_t                       file;
  assert_ok(h5_create(scratch("ours.h5"), &file));
  assert_ok(modal_model_write(file, &model, &from));
  assert_ok(h5_close(file));
}

static void test_ours_in_h5py(void **state) {
  (void)state;
  write_ours();
  assert_true(run("'%s' '%s' check '%s'", python, foreign, scratch("ours.h5")));
}

static void test_ours_in_h5dump(void **state) {
  (void)state;
  if (!run("h5dump --version >'%s'", scratch("version"), "", "")) skip();
  write_ours();
  assert_true(run("h5dump '%s' >'%s' 2>&1", scratch("ours.h5"), scratch("dump"), ""));
  size_t size;
  char  *text = slurp(scratch("dump"), &size);
  text[size]  = '\0';
  assert_non_null(strstr(text, "-0.125"));
  assert_non_null(strstr(text, "kg^-1/2"));
  assert_null(strstr(text, "error"));
  free(text);
}

int main(int argc, char **argv) {
  if (argc != 4) return 2;
  python  = argv[1];
  foreign = argv[2];
  example = argv[3];
  if (!run("'%s' -c 'import h5py, numpy' 2>/dev/null", python, "", "")) return 77;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_example),
      cmocka_unit_test(test_others_types),
      cmocka_unit_test(test_ours_in_h5py),
      cmocka_unit_test(test_ours_in_h5dump),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
