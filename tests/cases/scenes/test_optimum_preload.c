/* cases/optimum_preload: the optimum that tracking finds, against frequency sweeps beside it. */
#include <stdlib.h>

#include "tests/support/scene.h"

static char          folder[SCRATCH_PATH];
static mhb_response *tracked, *around;

static int run_scene(void **state) {
  (void)state;
  scratch_create(folder);
  scene_run(folder, SCENE, "case.yaml", "optimum_preload", &tracked);
  scene_run(folder, SCENE, "around.yaml", "around_optimum", &around);
  return 0;
}

static int clean(void **state) {
  (void)state;
  mhb_response_destroy(tracked);
  mhb_response_destroy(around);
  scratch_remove(folder);
  return 0;
}

/* Highest amplitude of the first probe over all curves of a preload. */
static double highest(const mhb_response *r, double n0, double *frequency) {
  double most = 0;
  for (int b = 0; b < r->n_branches; b++)
    for (int i = 0; i < r->branch[b].n_points; i++) {
      const mhb_branch *branch = &r->branch[b];
      double            a      = mhb_response_output(r, branch, i);
      if (branch->kind != MHB_BRANCH_NONLINEAR || branch->n0[i] != n0 || a <= most) continue;
      most       = a;
      *frequency = branch->frequency[i];
    }
  return most;
}

static void the_optimum_is_the_number_of_the_page(void **state) {
  (void)state;
  const mhb_optimum *o = &tracked->optimum;
  print_message("n0 %.7f N (bracket %.1e), %.4f um at %.4f Hz\n", o->value, o->error,
                1e6 * o->amplitude, o->frequency[0]);
  assert_int_equal(o->kind, MHB_OPTIMUM_SMOOTH);
  assert_true(o->verified);
  assert_near(o->value, 11.84228, 2e-3);
  assert_near(o->amplitude, 35.07e-6, 0.02e-6);
  assert_near(o->frequency[0], 213.489, 2e-3);
  assert_below(o->error, 1e-7);
}

/* A sweep at the optimum has this peak; sweeps beside it have higher ones. */
static void no_preload_beside_it_is_better(void **state) {
  (void)state;
  static const double n0[] = {11.4, 11.7, 11.842285, 12, 12.3};
  double              a[5], f[5];
  for (int i = 0; i < 5; i++) {
    a[i] = highest(around, n0[i], &f[i]);
    print_message("n0 %g N: highest %.6f um at %.4f Hz\n", n0[i], 1e6 * a[i], f[i]);
  }
  for (int i = 0; i < 5; i++)
    if (i != 2) assert_true(a[i] > a[2] * (1 + 1e-7));
  /* other harmonics than the sweep's: its tolerance is 1 % */
  assert_near(a[2] / tracked->optimum.amplitude, 1, 5e-3);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_optimum_is_the_number_of_the_page),
                                     cmocka_unit_test(no_preload_beside_it_is_better)};
  return cmocka_run_group_tests(tests, run_scene, clean);
}
