/* Statistics of a study against those of its closed form. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "cases/plan/design_statistics.h"
#include "cases/plan/distribution.h"
#include "cases/plan/sampling.h"
#include "cases/plan/sobol_indices.h"
#include "tests/support/check.h"

enum { BLOCKS = 512, EACH = 1000 };

static const plan_distribution normal = {PLAN_NORMAL, {0, 1, 0, 0}};

static void put(design_study *s, const double *key, double value) {
  study_design *d = design_study_add(s, key);
  assert_non_null(d);
  d->state    = STUDY_DONE;
  d->value[0] = value;
}

/* y = 3 a + b of two standard normal keys: variance 10, indices 0.9 and 0.1, no interaction. */
static void a_sum_has_its_statistics(void **state) {
  (void)state;
  static double u[BLOCKS * 4 * 2];
  design_study  s;
  assert_int_equal(plan_saltelli(BLOCKS, 2, 1, u), SHB_OK);
  assert_int_equal(design_study_create(2, 1, 0, &s), SHB_OK);
  for (int i = 0; i < BLOCKS * 4; i++) {
    const double key[2] = {plan_quantile(&normal, u[2 * i]), plan_quantile(&normal, u[2 * i + 1])};
    put(&s, key, 3 * key[0] + key[1]);
  }
  s.design[5].state            = STUDY_FAILED; /* a point B */
  s.design[6].state            = STUDY_FAILED; /* for the indices only */
  const design_samples samples = {0, BLOCKS * 4, true, 1};
  assert_int_equal(design_statistics(&samples, &s), SHB_OK);
  const study_uncertainty *w = &s.uncertainty;
  print_message("mean %.4f, deviation %.4f, 95 %% at %.4f (%.3f to %.3f), indices %.4f %.4f\n",
                w->mean[0], w->deviation[0], w->percentile[2], w->percentile_low[2],
                w->percentile_high[2], w->first[0], w->total[1]);
  assert_int_equal(w->n_samples, 2 * BLOCKS - 1);
  assert_int_equal(w->n_failed, 1);
  assert_near(w->mean[0], 0, 0.02);
  assert_near(w->deviation[0], sqrt(10), 0.05);
  assert_near(w->percentile[2], 1.6448536 * sqrt(10), 0.15);
  assert_true(w->percentile_low[2] < 1.6448536 * sqrt(10));
  assert_true(w->percentile_high[2] > 1.6448536 * sqrt(10));
  for (int k = 0; k < 2; k++) {
    const double exact = k ? 0.1 : 0.9;
    assert_near(w->first[k], exact, 0.03);
    assert_near(w->total[k], exact, 0.03);
    assert_true(w->first_low[k] < exact && exact < w->first_high[k]);
    assert_true(w->total_low[k] < exact && exact < w->total_high[k]);
  }
  design_study_free(&s);
}

/* y = v + z at three values v; in the second group all designs failed. */
static void each_group_has_its_own(void **state) {
  (void)state;
  static double u[EACH];
  design_study  s;
  assert_int_equal(plan_sobol(EACH, 1, 1, u), SHB_OK);
  assert_int_equal(design_study_create(2, 1, 0, &s), SHB_OK);
  for (int i = 0; i < 3 * EACH; i++) {
    const int    group = i / EACH;
    const double v = 10 * group, z = plan_quantile(&normal, u[i % EACH]);
    put(&s, (double[]){v, z}, v + z);
    if (group == 1) s.design[i].state = STUDY_FAILED;
  }
  const design_samples samples = {1, EACH, false, 1};
  assert_int_equal(design_statistics(&samples, &s), SHB_OK);
  const study_robust *r = &s.robust;
  assert_int_equal(r->n_groups, 3);
  assert_null(s.uncertainty.mean);
  assert_near(r->key[2], 20, 0);
  assert_near(r->mean[0], 0, 0.01);
  assert_near(r->mean[2], 20, 0.01);
  assert_near(r->percentile[2 * 3 + 2], 21.6448536, 0.02);
  assert_true(isnan(r->mean[1]));
  assert_int_equal(r->n_failed[1], EACH);
  assert_int_equal(r->n_samples[2], EACH);
  design_study_free(&s);
}

/* An output that does not vary has percentiles and no indices. */
static void a_constant_has_no_indices(void **state) {
  (void)state;
  design_study s;
  assert_int_equal(design_study_create(2, 1, 0, &s), SHB_OK);
  for (int i = 0; i < 16; i++) put(&s, (double[]){i, 1}, 7);
  const design_samples samples = {0, 16, true, 1};
  assert_int_equal(design_statistics(&samples, &s), SHB_OK);
  assert_near(s.uncertainty.percentile[1], 7, 0);
  assert_true(isnan(s.uncertainty.percentile_high[2]));
  assert_true(isnan(s.uncertainty.total[0]));
  design_study_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_sum_has_its_statistics),
      cmocka_unit_test(each_group_has_its_own),
      cmocka_unit_test(a_constant_has_no_indices),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
