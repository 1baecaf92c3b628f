/* The ladder of contact points of shroudhb converge, on a face of four pairs. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include <cmocka.h>

#include "modal/hdf5/h5.h"
#include "postproc/analysis/convergence.h"
#include "tests/support/check.h"
#include "tests/support/scratch.h"
#include "tests/support/shroud_face.h"

enum { PAIRS = 4 };

static char folder[SCRATCH_PATH];

static const char text[] =
    "name: face\n"
    "modal: {file: face.h5}\n"
    "contact: {to: ground, psi: 0, phi: 0, mu: 0.3, ku: 2e5, kv: 2e5, n0: [4 kN]}\n"
    "mhb: {frequency: [215 Hz, 330 Hz], harmonics: 3}\n"
    "converge: {tolerance: 5 %, seconds: 0.01 s, output: contact}\n";

static void write_model(void) {
  char           path[2 * SCRATCH_PATH];
  double         position[3 * PAIRS] = {0};
  hid_t          file;
  modal_model    model;
  shb_provenance provenance = {"", "", "", ""};
  smooth_face_model(PAIRS, 40, &model);
  for (int i = 0; i < PAIRS; i++) position[3 * i + 1] = 2. * i / (PAIRS - 1) - 1;
  snprintf(path, sizeof path, "%s/face.h5", folder);
  assert_int_equal(h5_create(path, &file), SHB_OK);
  assert_int_equal(modal_model_write(file, &model, &provenance), SHB_OK);
  assert_int_equal(h5_write_double(file, "contact/coordinates", H5_SHAPE(1, PAIRS, 3), position,
                                   "m", "centroids of the patches"),
                   SHB_OK);
  assert_int_equal(h5_close(file), SHB_OK);
  modal_model_free(&model);
}

static void errors_fall_with_the_points(void **state) {
  (void)state;
  static const char *const name[] = {"1", "2", "4"};
  char                     command[8 * SCRATCH_PATH], path[2 * SCRATCH_PATH];
  post_convergence         result;
  double                   before = INFINITY;
  int                      found  = 0;
  scratch_create(folder);
  write_model();
  scratch_write(folder, "case.yaml", text, strlen(text));
  snprintf(command, sizeof command, "cd '%s' && '%s' converge --quiet case.yaml", folder, SHROUDHB);
  int code = WEXITSTATUS(system(command));
  assert_true(code == 0 || code == 3); /* 3: a ladder has no rung below its finest that will do */
  snprintf(path, sizeof path, "%s/face.converge.h5", folder);
  if (post_convergence_read(path, &result) != SHB_OK) fail_msg("%s", shb_message());
  for (int i = 0; i < result.n; i++) {
    const post_rung *r = &result.rung[i];
    if (r->ladder != POST_LADDER_POINTS) continue;
    print_message("%s points: peak %.1e, frequency %.1e, curve %.1e, %.0f unknowns\n", r->name,
                  r->peak, r->frequency, r->curve, r->unknowns);
    assert_true(found < 3);
    assert_string_equal(r->name, name[found]);
    assert_int_equal(r->state, POST_RUNG_DONE);
    assert_int_equal((int)r->unknowns, 3 * 7 * atoi(name[found])); /* 3 harmonics */
    assert_int_equal(r->reference, found == 2);
    assert_int_equal(r->of_case, found == 2);
    assert_true(post_rung_error(r) < before);
    before = post_rung_error(r);
    found++;
  }
  assert_int_equal(found, 3);
  assert_true(before == 0);
  post_convergence_free(&result);
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  assert_int_equal(system(command), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(errors_fall_with_the_points)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
