#include "cases/plan/statistics.h"

#include <gsl/gsl_randist.h>

#include "tests/support/check.h"

static void moments_of_a_few_numbers(void **state) {
  (void)state;
  const double y[] = {2, NAN, 4, 4, 4, 5, INFINITY, 5, 7, 9};
  plan_moments m;
  assert_ok(plan_moments_of(10, y, &m));
  assert_int_equal(m.n, 8);
  assert_int_equal(m.n_failed, 2);
  assert_near(m.mean, 5, 1e-14);
  assert_near(m.deviation, sqrt(32.0 / 7), 1e-14);
  assert_near(m.mean_error, sqrt(32.0 / 7 / 8), 1e-14);
  assert_near(m.least, 2, 0);
  assert_near(m.greatest, 9, 0);
  assert_refused(plan_moments_of(1, y + 1, &m), SHB_ERR_INPUT, "all 1 samples failed");
  assert_ok(plan_moments_of(1, y, &m));
  assert_true(isnan(m.deviation) && isnan(m.mean_error));
}

/* In many samples the errors of mean and deviation are those that single samples tell. */
static void errors_are_as_large_as_told(void **state) {
  (void)state;
  enum { SAMPLES = 2000, N = 100 };
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  double   mean[SAMPLES], deviation[SAMPLES], told_mean = 0, told_deviation = 0, y[N];
  for (int k = 0; k < SAMPLES; k++) {
    for (int i = 0; i < N; i++) y[i] = gsl_ran_flat(random, 3, 8);
    plan_moments m;
    assert_ok(plan_moments_of(N, y, &m));
    mean[k]      = m.mean;
    deviation[k] = m.deviation;
    told_mean += m.mean_error / SAMPLES;
    told_deviation += m.deviation_error / SAMPLES;
  }
  gsl_rng_free(random);
  plan_moments of_mean, of_deviation;
  assert_ok(plan_moments_of(SAMPLES, mean, &of_mean));
  assert_ok(plan_moments_of(SAMPLES, deviation, &of_deviation));
  printf("error of the mean %.4f, told %.4f; of the deviation %.4f, told %.4f; bounds 6 %%\n",
         of_mean.deviation, told_mean, of_deviation.deviation, told_deviation);
  assert_within(told_mean, of_mean.deviation, 0.06);
  assert_within(told_deviation, of_deviation.deviation, 0.06);
}

/* Ranks of the 95 % bounds of the median of 20 values: 6 and 15, with coverage 0.9586. */
static void ranks_are_those_of_the_tables(void **state) {
  (void)state;
  double          y[20];
  plan_percentile p;
  for (int i = 0; i < 20; i++) y[i] = (7 * i) % 20 + 1;
  assert_ok(plan_percentile_of(20, y, 0.5, 0.95, &p));
  assert_near(p.low, 6, 0);
  assert_near(p.high, 15, 0);
  assert_near(p.value, 10.5, 1e-12);
  assert_near(p.coverage, 0.95861053, 1e-8);
  assert_ok(plan_percentile_of(20, y, 0.95, 0.95, &p)); /* 20 values bound it from below only */
  assert_true(isfinite(p.low) && p.high == INFINITY);
  assert_true(p.coverage >= 0.95);
}

static void bounds_hold_the_percentile_as_often_as_told(void **state) {
  (void)state;
  enum { SAMPLES = 4000, N = 150 };
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  double   y[N], quantile = -log(0.1); /* the 90 % percentile of an exponential distribution */
  int      below = 0, above = 0;
  plan_percentile p;
  for (int k = 0; k < SAMPLES; k++) {
    for (int i = 0; i < N; i++) y[i] = gsl_ran_exponential(random, 1);
    assert_ok(plan_percentile_of(N, y, 0.9, 0.9, &p));
    below += quantile < p.low;
    above += quantile > p.high;
  }
  gsl_rng_free(random);
  double held = 1 - (double)(below + above) / SAMPLES;
  printf("held in %.2f %% of the samples, told %.2f %%; missed %d below, %d above\n", 100 * held,
         100 * p.coverage, below, above);
  assert_near(held, p.coverage, 0.015);
  assert_true(held > 0.89);
  assert_below((double)below / SAMPLES, 0.06);
  assert_below((double)above / SAMPLES, 0.06);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(moments_of_a_few_numbers),
      cmocka_unit_test(errors_are_as_large_as_told),
      cmocka_unit_test(ranks_are_those_of_the_tables),
      cmocka_unit_test(bounds_hold_the_percentile_as_often_as_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
