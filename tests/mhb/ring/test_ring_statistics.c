/* Means of correlated series, percentiles, and the random numbers of the starts. */
#include "mhb/ring/noise.h"
#include "mhb/ring/ring_statistics.h"
#include "tests/support/check.h"

/* A first-order series x_i = r x_{i-1} + noise about 2.385. */
static void series(double r, double size, int n, mhb_noise *noise, double *x) {
  double state = 0;
  for (int i = 0; i < n; i++) {
    state = r * state + size * mhb_noise_normal(noise);
    x[i]  = 2.385 + state;
  }
}

/* The standard error is that of many repetitions. */
static void the_standard_error_is_right(void **state) {
  (void)state;
  enum { N = 200, REPEATED = 400 };
  mhb_noise noise = {.state = 7};
  for (int k = 0; k < 2; k++) {
    double r = .5 * k, square = 0, claimed = 0, x[N];
    for (int i = 0; i < REPEATED; i++) {
      series(r, .1, N, &noise, x);
      mhb_block_mean m = mhb_block_mean_of(x, N);
      square += pow(m.mean - 2.385, 2) / REPEATED;
      claimed += m.error / REPEATED;
    }
    print_message("correlation %.1f: error %.5f, claimed %.5f\n", r, sqrt(square), claimed);
    assert_within(claimed, sqrt(square), .15);
  }
}

static void a_drift_is_not_settled(void **state) {
  (void)state;
  mhb_noise noise = {.state = 11};
  double    x[20], y[20];
  series(0, .01, 20, &noise, x);
  mhb_block_mean even = mhb_block_mean_of(x, 20);
  for (int i = 0; i < 20; i++) y[i] = x[i] + .02 * i;
  mhb_block_mean rising = mhb_block_mean_of(y, 20);
  assert_true(mhb_block_mean_is_settled(&even));
  assert_false(mhb_block_mean_is_settled(&rising));
  assert_near(rising.drift - even.drift, .2, 1e-12);
}

static void a_percentile_counts(void **state) {
  (void)state;
  double x[1000];
  for (int i = 0; i < 1000; i++) x[i] = (i * 389) % 1000 + 1;
  assert_true(mhb_percentile(x, 1000, .999) == 999);
  assert_true(mhb_percentile(x, 1000, .5) == 500);
  for (int i = 0; i < 1000; i++) x[i] = (i * 389) % 1000 + 1;
  double least = 1000;
  for (int i = 0; i < 150; i++) least = fmin(least, x[i]);
  assert_true(mhb_percentile(x, 150, 0) == least);
}

static void the_noise_is_normal_and_repeats(void **state) {
  (void)state;
  mhb_noise a = {.state = 20}, b = {.state = 20};
  double    sum = 0, square = 0, fourth = 0;
  enum { N = 100000 };
  for (int i = 0; i < N; i++) {
    double x = mhb_noise_normal(&a);
    assert_true(x == mhb_noise_normal(&b));
    sum += x / N;
    square += x * x / N;
    fourth += pow(x, 4) / N;
  }
  assert_small(sum, .01);
  assert_near(square, 1, .02);
  assert_near(fourth, 3, .15);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_standard_error_is_right),
      cmocka_unit_test(a_drift_is_not_settled),
      cmocka_unit_test(a_percentile_counts),
      cmocka_unit_test(the_noise_is_normal_and_repeats),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
