/* The study of the preload that is robust: the numbers of its README. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "postproc/study/study_effects.h"
#include "postproc/study/study_file.h"
#include "tests/support/check.h"
#include "tests/support/scene.h"

enum { GROUPS = 5, EACH = 72, LEVELS = 3 };

static char         folder[SCRATCH_PATH];
static design_study study;

static int run_study(void **state) {
  (void)state;
  char path[SCRATCH_PATH + 64];
  scratch_create(folder);
  if (scene_run_study(folder, SCENE, "robust_preload") != 0) return 1;
  snprintf(path, sizeof path, "%s/robust_preload/robust_preload.study.h5", folder);
  return study_file_read(path, &study) != SHB_OK;
}

static int clean(void **state) {
  (void)state;
  design_study_free(&study);
  return scene_remove(folder);
}

static const double *percentiles(const double *of, int group) {
  return of + group * study.n_outputs * LEVELS; /* of the first output */
}

/* um: percentiles 5, 50 and 95 %, and the bounds of the last */
static void percentiles_are_those_of_the_table(void **state) {
  (void)state;
  static const double preload[GROUPS]            = {10, 12, 14, 17, 21};
  static const double wanted[GROUPS][LEVELS + 2] = {{28.63, 36.17, 43.27, 41.53, 61.57},
                                                    {28.50, 35.22, 42.87, 40.53, 49.39},
                                                    {29.74, 35.41, 41.51, 39.91, 46.77},
                                                    {31.83, 36.04, 45.88, 42.38, 54.15},
                                                    {33.43, 41.09, 54.24, 50.00, 63.54}};
  double              worst                      = 0;
  assert_int_equal(study.n, GROUPS * EACH);
  assert_int_equal(study.robust.n_groups, GROUPS);
  for (int g = 0; g < GROUPS; g++) {
    const double *p               = percentiles(study.robust.percentile, g);
    const double  row[LEVELS + 2] = {p[0], p[1], p[2],
                                     percentiles(study.robust.percentile_low, g)[2],
                                     percentiles(study.robust.percentile_high, g)[2]};
    assert_near(study.robust.key[g], preload[g], 1e-12);
    assert_int_equal(study.robust.n_samples[g], EACH);
    for (int i = 0; i < LEVELS + 2; i++)
      worst = fmax(worst, fabs(row[i] / (1e-6 * wanted[g][i]) - 1));
  }
  print_message("percentiles within %.1e\n", worst);
  assert_true(worst < 0.01);
}

/* Its interval is clear of 21 N and of no other preload. */
static void fourteen_newtons_are_best_and_told_from_21(void **state) {
  (void)state;
  int level, best = study_best_group(&study, &level);
  assert_int_equal(best, 2);
  assert_near(study.robust.level[level], 95, 0);
  assert_int_equal(study_count_equal_groups(&study, best, level), GROUPS - 2);
}

/* 35.07 um is the optimum without scatter, cases/optimum_preload. */
static void scatter_costs_a_fifth(void **state) {
  (void)state;
  assert_near(percentiles(study.robust.percentile, 2)[2] / 35.07e-6, 1.18, 0.02);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(percentiles_are_those_of_the_table),
      cmocka_unit_test(fourteen_newtons_are_best_and_told_from_21),
      cmocka_unit_test(scatter_costs_a_fifth),
  };
  return cmocka_run_group_tests(tests, run_study, clean);
}
