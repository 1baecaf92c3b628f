#include "cases/plan/distribution.h"
#include "cases/plan/sampling.h"
#include "tests/support/check.h"

enum { N = 1024, D = 5 };

/* Mean, deviation of a distribution from the midpoints of many equal slices of probability. */
static void moments(const plan_distribution *distribution, double *mean, double *deviation) {
  const int n      = 200000;
  double    second = 0;
  *mean            = 0;
  for (int i = 0; i < n; i++) *mean += plan_quantile(distribution, (i + 0.5) / n) / n;
  for (int i = 0; i < n; i++) {
    double step = plan_quantile(distribution, (i + 0.5) / n) - *mean;
    second += step * step / n;
  }
  *deviation = sqrt(second);
}

static void distributions_have_their_moments(void **state) {
  (void)state;
  /* Truncated normal on mean + [-1, 2] deviations: Johnson, Kotz 1994, sec. 13.10.1. */
  double pa = exp(-0.5) / sqrt(2 * M_PI), pb = exp(-2.0) / sqrt(2 * M_PI);
  double P = (erf(2 / M_SQRT2) + erf(1 / M_SQRT2)) / 2, shift = (pa - pb) / P;
  double ratio    = log(7.3 / 1.9);
  double log_mean = (7.3 - 1.9) / ratio;
  const struct {
    plan_distribution distribution;
    double            mean, deviation;
  } rows[] = {
      {{PLAN_UNIFORM, {1.9, 7.3}}, 4.6, 5.4 / sqrt(12)},
      {{PLAN_LOG_UNIFORM, {1.9, 7.3}},
       log_mean,
       sqrt((7.3 * 7.3 - 1.9 * 1.9) / (2 * ratio) - log_mean * log_mean)},
      {{PLAN_NORMAL, {0.3, 0.05}}, 0.3, 0.05},
      {{PLAN_LOGNORMAL, {2.7, 0.8}}, 2.7, 0.8},
      {{PLAN_TRIANGULAR, {1, 2.5, 6}}, 9.5 / 3, sqrt((1 + 6.25 + 36 - 2.5 - 6 - 15) / 18)},
      {{PLAN_TRUNCATED_NORMAL, {0.3, 0.05, 0.25, 0.4}},
       0.3 + 0.05 * shift,
       0.05 * sqrt(1 - (pa + 2 * pb) / P - shift * shift)},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    double mean, deviation;
    assert_ok(plan_distribution_check(&rows[i].distribution, "mu"));
    moments(&rows[i].distribution, &mean, &deviation);
    printf("%-17s mean off by %.1e, deviation by %.1e, bounds 1e-5, 2e-4\n",
           plan_distribution_name(rows[i].distribution.kind), fabs(mean / rows[i].mean - 1),
           fabs(deviation / rows[i].deviation - 1));
    assert_within(mean, rows[i].mean, 1e-5);
    assert_within(deviation, rows[i].deviation, 2e-4);
  }
}

static void a_far_tail_keeps_its_digits(void **state) {
  (void)state;
  /* Above 12 deviations the excess is nearly exponential with the rate 12 (Mills' ratio). */
  plan_distribution tail = {PLAN_TRUNCATED_NORMAL, {1, 0.1, 2.2, 9}};
  plan_distribution low  = {PLAN_TRUNCATED_NORMAL, {-1, 0.1, -9, -2.2}};
  assert_ok(plan_distribution_check(&tail, "n0"));
  double excess = plan_quantile(&tail, 0.5) - 2.2;
  assert_within(excess, 0.1 * log(2) / 12, 0.02);
  assert_near(plan_quantile(&low, 0.5), -plan_quantile(&tail, 0.5), 1e-12);
}

static void wrong_parameters_are_refused(void **state) {
  (void)state;
  const struct {
    plan_distribution distribution;
    const char       *part;
  } rows[] = {
      {{PLAN_UNIFORM, {2, 1}}, "mu: uniform: the lower end"},
      {{PLAN_LOG_UNIFORM, {0, 1}}, "0 < lower end"},
      {{PLAN_NORMAL, {0.3, 0}}, "deviation must be above 0"},
      {{PLAN_LOGNORMAL, {-1, 1}}, "above 0"},
      {{PLAN_TRIANGULAR, {1, 5, 4}}, "mode"},
      {{PLAN_TRUNCATED_NORMAL, {0, 1, 3, 2}}, "lower end"},
      {{PLAN_TRUNCATED_NORMAL, {0, 1, 60, 70}}, "too far from the mean"},
      {{PLAN_NORMAL, {NAN, 1}}, "parameter 1 of normal is not a finite number"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    assert_refused(plan_distribution_check(&rows[i].distribution, "mu"), SHB_ERR_INPUT,
                   rows[i].part);
}

/* Each of n slices of each coordinate holds one point. */
static void assert_one_a_slice(int n, const double *u) {
  for (int i = 0; i < D; i++) {
    int *count = calloc((size_t)n, sizeof *count);
    for (int j = 0; j < n; j++) {
      double value = u[j * D + i];
      assert_true(value > 0 && value < 1);
      count[(int)(value * n)]++;
    }
    for (int j = 0; j < n; j++) assert_int_equal(count[j], 1);
    free(count);
  }
}

static void every_slice_has_one_point(void **state) {
  (void)state;
  static double u[N * D], v[N * D];
  assert_ok(plan_sobol(N, D, 3, u));
  assert_one_a_slice(N, u);
  assert_ok(plan_sobol(N / 4, D, 3, v)); /* fewer points begin the same */
  assert_memory_equal(u, v, N / 4 * D * sizeof *u);
  assert_ok(plan_sobol(N, D, 4, v));
  assert_memory_not_equal(u, v, sizeof u);
  assert_ok(plan_latin_hypercube(1000, D, 0, u));
  assert_one_a_slice(1000, u);
  assert_ok(plan_latin_hypercube(1000, D, 0, v));
  assert_memory_equal(u, v, 1000 * D * sizeof *u);
  assert_refused(plan_sobol(4, 41, 1, u), SHB_ERR_INPUT, "at most 40 dimensions, 41 are wanted");
}

/* The root mean square error of the mean of prod(1 + 0.5 (u - 1/2)), which is 1, over 16 seeds. */
static double mean_error(shb_status sample(int, int, unsigned long, double *), int n) {
  double *u      = malloc((size_t)n * D * sizeof *u);
  double  square = 0;
  for (unsigned long seed = 0; seed < 16; seed++) {
    double mean = 0;
    assert_ok(sample(n, D, seed, u));
    for (int j = 0; j < n; j++) {
      double product = 1;
      for (int i = 0; i < D; i++) product *= 1 + 0.5 * (u[j * D + i] - 0.5);
      mean += product / n;
    }
    square += (mean - 1) * (mean - 1) / 16;
  }
  free(u);
  return sqrt(square);
}

static void sobol_points_converge_with_order_one(void **state) {
  (void)state;
  double coarse = mean_error(plan_sobol, 64), fine = mean_error(plan_sobol, 16384);
  double order = log2(coarse / fine) / 8;
  double cube  = mean_error(plan_latin_hypercube, 16384);
  printf("error of a mean, 16384 points: Sobol' %.1e (order %.2f), Latin hypercube %.1e\n", fine,
         order, cube);
  assert_true(order > 0.8);
  /* A digital shift moves all points inside their slices of 1/n by one uniform length. */
  assert_within(fine, 0.5 * sqrt(D / 12.0) / 16384, 0.35);
  assert_below(cube, 1e-3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(distributions_have_their_moments),
      cmocka_unit_test(a_far_tail_keeps_its_digits),
      cmocka_unit_test(wrong_parameters_are_refused),
      cmocka_unit_test(every_slice_has_one_point),
      cmocka_unit_test(sobol_points_converge_with_order_one),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
