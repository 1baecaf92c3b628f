/* The example's blade at 3000 rpm with weak preload. At the onset of slip the curve turns back and
 * forth; with few harmonics it does not. `harmonics: auto` must keep the high number long
 * enough. */
#include "tests/support/scene.h"

#include <stdlib.h>

static char folder[SCRATCH_PATH], source[SCRATCH_PATH];

static const struct {
  double n0, fold[2]; /* N, Hz: with 13 harmonics throughout */
} curve[2] = {{20, {225.64, 227.80}}, {25, {232.60, 233.11}}};

static int prepare(void **state) {
  (void)state;
  char line[8 * SCRATCH_PATH];
  scratch_create(folder);
  scratch_create(source);
  snprintf(line, sizeof line,
           "sed -e 's/^name: .*/name: onset/' -e 's/speed: 0 rpm/speed: 3000 rpm/' -e 's/n0: "
           "\\[.*/n0: [20 N, 25 N]/' "
           "-e 's/frequency: .*/frequency: [215 Hz, 260 Hz]/' '%s/case.yaml' > '%s/onset.yaml'",
           SCENE, source);
  return system(line);
}

static int clean(void **state) {
  (void)state;
  scratch_remove(folder);
  scratch_remove(source);
  return 0;
}

static void folds_at_the_onset_of_slip_are_kept(void **state) {
  (void)state;
  mhb_response *r;
  scene_run(folder, source, "onset.yaml", "onset", &r);
  for (int i = 0; i < 2; i++) {
    const mhb_branch *b = scene_branch(r, MHB_BRANCH_NONLINEAR, curve[i].n0);
    int               point[8], n = scene_folds(b, 8, point);
    double            worst = 0;
    for (int p = 0; p < b->n_points; p++) worst = fmax(worst, b->error_truncation[p]);
    print_message("n0 = %g N: %d folds, worst estimate %.2g\n", curve[i].n0, n, worst);
    assert_int_equal(n, 2);
    for (int k = 0; k < 2; k++) {
      double f = fmin(b->frequency[point[0]], b->frequency[point[1]]);
      if (k == 1) f = fmax(b->frequency[point[0]], b->frequency[point[1]]);
      assert_within(f, curve[i].fold[k], 2e-4);
    }
    assert_true(worst < .02); /* tolerance .01 */
  }
  scene_is_sound(r);
  mhb_response_destroy(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(folds_at_the_onset_of_slip_are_kept)};
  return cmocka_run_group_tests(tests, prepare, clean);
}
