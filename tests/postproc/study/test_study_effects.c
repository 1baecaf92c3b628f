/* Main effects, the best design and units, against closed forms. */
#include "postproc/study/study_effects.h"

#include <math.h>
#include <string.h>

#include "tests/support/check.h"
#include "tests/support/studies.h"

/* A full grid of value = 3 x + y^2 over the levels of two keys. */
static void additive(design_study *s, int nx, int ny) {
  assert_int_equal(design_study_create(2, 1, 0, s), SHB_OK);
  strcpy(s->output[0].name, "peak");
  for (int i = 0; i < nx; i++)
    for (int j = 0; j < ny; j++) {
      study_design *d = design_study_add(s, (const double[]){i, j});
      assert_non_null(d);
      d->state    = STUDY_DONE;
      d->value[0] = 3. * i + j * j;
    }
}

/* Variance of 3 x and of y^2 over their levels: the shares of an additive function add up to 1. */
static void shares_of_an_additive_grid_are_exact(void **state) {
  (void)state;
  design_study s;
  additive(&s, 5, 4);
  double       vx = 9 * 2.0, vy = (0 + 1 + 16 + 81) / 4.0 - 3.5 * 3.5;
  study_effect x = study_main_effect(&s, 0, 0), y = study_main_effect(&s, 0, 1);
  print_message("shares %.15g + %.15g\n", x.share, y.share);
  assert_near(x.share, vx / (vx + vy), 1e-13);
  assert_near(y.share, vy / (vx + vy), 1e-13);
  assert_int_equal(x.n_groups, 5);
  assert_near(x.at[2], 2, 1e-13);
  assert_near(x.mean[2], 6 + 3.5, 1e-13);
  double share;
  assert_int_equal(study_chief_key(&s, &share), 0);
  assert_near(share, x.share, 1e-15);
  design_study_free(&s);
}

/* A key that does nothing has a share near zero, thanks to the correction for chance. */
static void an_idle_key_has_no_share(void **state) {
  (void)state;
  design_study s;
  studies_make(STUDIES_LARGE, &s);
  for (int i = 0; i < s.n; i++) s.design[i].value[0] = pow(s.design[i].key[1], 2);
  double idle = study_main_effect(&s, 0, 0).share, chief = study_main_effect(&s, 0, 1).share;
  print_message("idle key %.4f (0), chief key %.4f (1 - 1/12^2 = 0.993)\n", idle, chief);
  assert_true(idle < 0.01);
  assert_true(chief > 0.98 && chief < 1);
  design_study_free(&s);
}

static void no_share_where_it_means_nothing(void **state) {
  (void)state;
  design_study s;
  double       share;
  additive(&s, 2, 3);
  assert_true(isnan(study_main_effect(&s, 0, 0).share)); /* six designs are too few */
  design_study_free(&s);
  additive(&s, 5, 4);
  s.design[19].state = STUDY_WAITING;
  assert_true(isnan(study_main_effect(&s, 0, 0).share)); /* part of a grid is no sample either */
  s.design[19].state = STUDY_FAILED;
  assert_false(isnan(study_main_effect(&s, 0, 0).share));
  design_study_free(&s);
  studies_make(STUDIES_OPTIMISE, &s);
  assert_true(isnan(study_main_effect(&s, 0, 0).share)); /* a search is no sample */
  assert_int_equal(study_chief_key(&s, &share), -1);
  design_study_free(&s);
  studies_make(STUDIES_EMPTY, &s);
  assert_int_equal(study_best(&s), -1);
  assert_int_equal(study_main_effect(&s, 0, 0).n_groups, 0);
  design_study_free(&s);
}

static void designs_within_the_errors_are_counted(void **state) {
  (void)state;
  design_study s;
  additive(&s, 3, 3);
  assert_int_equal(study_best(&s), 0);
  assert_int_equal(study_count_equals(&s, 0), 0);
  s.design[0].error[0] = 0.5;
  s.design[1].error[0] = 0.5; /* value 1: just reached */
  assert_int_equal(study_count_equals(&s, 0), 1);
  s.design[0].state = STUDY_NOT_CONVERGED;
  assert_int_equal(study_best(&s), 1);
  design_study_free(&s);
}

static void columns_have_a_readers_unit(void **state) {
  (void)state;
  const study_column length = {"peak", "m", 0}, angle = {"psi", "rad", 0}, pure = {"mu", "-", 0},
                     slope = {"rate", "m/N", 0};
  assert_string_equal(study_unit(&length, 3e-5).name, "µm");
  assert_near(study_unit(&angle, 1).scale * 180, 3.14159265358979, 1e-12);
  assert_string_equal(study_unit(&pure, 1).name, "");
  assert_string_equal(study_unit(&slope, 1).name, "m/N");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shares_of_an_additive_grid_are_exact),
      cmocka_unit_test(an_idle_key_has_no_share),
      cmocka_unit_test(no_share_where_it_means_nothing),
      cmocka_unit_test(designs_within_the_errors_are_counted),
      cmocka_unit_test(columns_have_a_readers_unit),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
