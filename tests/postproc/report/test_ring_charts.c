/* The share of random rings over the amplification factor. */
#include "postproc/report/ring_charts.h"

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

/* In ascending order, by a third at each of the three factors done. */
static void the_share_rises_at_each_factor(void **state) {
  static const double wanted_x[]     = {1.1, 1.1, 1.3, 1.3, 1.7, 1.7},
                      wanted_share[] = {0, 1 / 3., 1 / 3., 2 / 3., 2 / 3., 1};
  mhb_samples *s                     = samples();
  double       x[2 * N], share[2 * N];
  (void)state;
  assert_int_equal(post_factor_corners(s, 0, x, share), 6);
  for (int i = 0; i < 6; i++) {
    assert_near(x[i], wanted_x[i], 0);
    assert_near(share[i], wanted_share[i], 1e-15);
  }
  assert_int_equal(post_factor_corners(s, 1, x, share), 0);
  s->mark[0] = 1; /* no result */
  assert_int_equal(post_factor_corners(s, 0, x, share), 4);
  assert_true(x[0] == 1.1 && x[3] == 1.7);
  mhb_samples_destroy(s);
}

static int count(const char *text, const char *part) {
  int n = 0;
  for (; (text = strstr(text, part)); text++) n++;
  return n;
}

static void a_curve_for_each_preload_with_factors(void **state) {
  mhb_samples *s    = samples();
  post_buffer  html = {0};
  (void)state;
  post_put_factors(s, &html);
  assert_int_equal(count(html.text, "n0 = 12.5 N"), 1);
  assert_int_equal(count(html.text, "class=\"line c0\""), 1);
  assert_int_equal(count(html.text, "line c1"), 0);
  assert_int_equal(count(html.text, "<section>"), count(html.text, "</section>"));
  post_buffer_free(&html);
  s->factor[4] = 1.2;
  s->factor[7] = 1.4;
  html         = (post_buffer){0};
  post_put_factors(s, &html);
  assert_int_equal(count(html.text, "class=\"line c1\""), 1);
  post_buffer_free(&html);
  memset(s->factor, 0, sizeof(double) * 2 * N);
  s->factor[0] = 1.2; /* one factor is no distribution */
  html         = (post_buffer){0};
  post_put_factors(s, &html);
  post_put_factors(NULL, &html);
  assert_int_equal(html.length, 0);
  mhb_samples_destroy(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_share_rises_at_each_factor),
                                     cmocka_unit_test(a_curve_for_each_preload_with_factors)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
