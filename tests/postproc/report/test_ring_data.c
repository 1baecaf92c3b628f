/* Amplification factors of random rings, as numbers of the page. */
#include "postproc/report/ring_data.h"

#include <string.h>

#include "tests/support/check.h"

enum { N = 4 };

static mhb_samples *samples(void) {
  static const double factor[2][N] = {{1.3, 1.1, 0, 1.7}, {0, 0, 0, 0}};
  mhb_samples        *s            = mhb_samples_create(N, 2, 3);
  memcpy(s->factor, factor, sizeof factor);
  s->n0[0] = 12.5;
  s->n0[1] = 30;
  return s;
}

/* Those that are done and not marked, in the order of the samples. */
static void factors_that_are_results(void **state) {
  mhb_samples *s   = samples();
  post_buffer  out = {0};
  (void)state;
  s->mark[0] = 1;
  assert_true(post_put_factors(s, &out));
  assert_string_equal(
      out.text, ",\n\"factors\":[{\"n0\":12.5,\"factor\":[1.1,1.7]},{\"n0\":30,\"factor\":[]}]");
  post_buffer_free(&out);
  mhb_samples_destroy(s);
}

static void one_factor_is_no_distribution(void **state) {
  mhb_samples *s   = samples();
  post_buffer  out = {0};
  (void)state;
  memset(s->factor, 0, sizeof(double) * 2 * N);
  s->factor[0] = 1.2;
  assert_false(post_put_factors(s, &out));
  assert_false(post_put_factors(NULL, &out));
  assert_int_equal(out.length, 0);
  mhb_samples_destroy(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(factors_that_are_results),
                                     cmocka_unit_test(one_factor_is_no_distribution)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
