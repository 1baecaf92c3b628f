/* Distribution of the factors of random samples: quantiles, their bounds, the file. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/numerics/random.h"
#include "mhb/response/response_samples.h"
#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

/* Ranks of 100 samples as in tables of order statistics: median 40 and 61; 95 %: 90 and 100. */
static void bounds_are_order_statistics(void **state) {
  mhb_samples *s;
  double       q[3];
  (void)state;
  s = mhb_samples_create(101, 2, 3);
  for (int i = 0; i < 100; i++) s->factor[101 + (i * 37) % 101] = 1 + (i * 37) % 101;
  const int left_out = 37 * 100 % 101; /* its factor stays 0 */
  assert_int_equal(mhb_samples_done(s, 1), 100);
  assert_int_equal(mhb_samples_done(s, 0), 0);
  assert_int_equal(mhb_samples_worst(s, 0), -1);
  assert_int_equal(mhb_samples_worst(s, 1), 100);
  double sorted[100];
  for (int i = 0, n = 0; i < 101; i++)
    if (i != left_out) sorted[n++] = 1 + i;
  mhb_samples_quantile(s, 1, 0.5, q);
  assert_near(q[0], 0.5 * (sorted[49] + sorted[50]), 1e-12);
  assert_near(q[1], sorted[39], 0);
  assert_near(q[2], sorted[60], 0);
  mhb_samples_quantile(s, 1, 0.95, q);
  assert_near(q[1], sorted[89], 0);
  assert_near(q[2], sorted[99], 0);
  mhb_samples_quantile(s, 1, 0.99, q);
  assert_true(isnan(q[2]) && q[1] > 0); /* 100 samples do not bound it from above */
  mhb_samples_quantile(s, 0, 0.5, q);
  assert_true(isnan(q[0]) && isnan(q[1]) && isnan(q[2]));
  mhb_samples_destroy(s);
}

/* The bounds hold the true quantile in 95 % of the cases at least, and not in all of them. */
static void bounds_hold_the_quantile(void **state) {
  enum { TRIALS = 4000, N = 60 };
  unsigned long long seed = 5;
  mhb_samples       *s;
  int                held = 0;
  (void)state;
  s = mhb_samples_create(N, 1, 1);
  for (int t = 0; t < TRIALS; t++) {
    double q[3];
    for (int i = 0; i < N; i++) s->factor[i] = 1.5 + 0.5 * mhb_random(&seed); /* 1 to 2 */
    mhb_samples_quantile(s, 0, 0.7, q);
    held += q[1] <= 1.7 && 1.7 <= q[2];
  }
  assert_true(held >= 0.95 * TRIALS - 3 * sqrt(TRIALS * 0.05) && held < 0.99 * TRIALS);
  mhb_samples_destroy(s);
}

/* Samples without a result are left out of quantile and worst. The bounds hold wherever they are:
 * tables of 100 samples, five of which count as the least below and as the largest above. */
static void marked_samples_are_no_result(void **state) {
  enum { N = 100, MARKED = 5 };
  mhb_samples *s;
  double       q[3];
  (void)state;
  s = mhb_samples_create(N, 1, 3);
  for (int i = 0; i < N; i++) s->factor[i] = 1 + i;
  for (int i = 0; i < MARKED; i++) s->mark[N - 1 - 7 * i] = 1; /* 100, 93, 86, 79, 72 */
  assert_int_equal(mhb_samples_done(s, 0), N);
  assert_int_equal(mhb_samples_marked(s, 0), MARKED);
  assert_int_equal(mhb_samples_worst(s, 0), N - 2);
  mhb_samples_quantile(s, 0, 0.5, q);
  assert_near(q[0], 48, 1e-12);          /* of 95 */
  assert_near(q[1], 40 - MARKED, 1e-12); /* rank 40 of all, five of them below */
  assert_near(q[2], 61, 1e-12);
  mhb_samples_quantile(s, 0, 0.95, q);
  assert_true(isnan(q[2])); /* rank 100 may be a marked one */
  for (int i = 0; i < N; i++) s->mark[i] = 1;
  mhb_samples_quantile(s, 0, 0.5, q);
  assert_true(isnan(q[0]) && isnan(q[1]) && isnan(q[2]));
  assert_int_equal(mhb_samples_worst(s, 0), -1);
  mhb_samples_destroy(s);
}

static void file_holds_them(void **state) {
  hid_t        file;
  mhb_samples *s, *back;
  (void)state;
  s = mhb_samples_create(4, 2, 3);
  for (int i = 0; i < 8; i++) {
    s->factor[i]    = i == 3 ? 0 : 1 + 0.1 * i;
    s->frequency[i] = 200 + i;
    s->blade[i]     = i % 3;
    s->mark[i]      = i == 5;
  }
  for (int i = 0; i < 12; i++) s->deviation[i] = 0.001 * i;
  s->n0[1] = 40;
  file     = H5Fcreate(scratch("s.h5"), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(file >= 0);
  assert_ok(mhb_samples_write(file, s));
  assert_ok(mhb_samples_read(file, &back));
  H5Fclose(file);
  assert_int_equal(back->n, 4);
  assert_int_equal(back->preloads, 2);
  assert_memory_equal(back->factor, s->factor, 8 * sizeof(double));
  assert_memory_equal(back->frequency, s->frequency, 8 * sizeof(double));
  assert_memory_equal(back->blade, s->blade, 8 * sizeof(int));
  assert_memory_equal(back->mark, s->mark, 8 * sizeof(int));
  assert_memory_equal(back->deviation, s->deviation, 12 * sizeof(double));
  assert_memory_equal(back->n0, s->n0, 2 * sizeof(double));
  mhb_samples_destroy(back);
  mhb_samples_destroy(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bounds_are_order_statistics), cmocka_unit_test(bounds_hold_the_quantile),
      cmocka_unit_test(marked_samples_are_no_result), cmocka_unit_test(file_holds_them)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
