/* Every number comes back from its text, and short ones stay short. */
#include "mesh/base/shortest.h"

#include <float.h>
#include <stdlib.h>

#include "tests/support/check.h"

static void numbers_come_back(void **state) {
  (void)state;
  char   text[SHB_SHORTEST];
  double x = 1;
  for (int i = 0; i < 10000; i++) {
    x = i % 100 ? x * -1.0123456789 : 1e-300 * pow(10, i / 17.);
    assert_true(strtod(shb_shortest(x, text), NULL) == x);
  }
  assert_true(strtod(shb_shortest(DBL_MAX, text), NULL) == DBL_MAX);
  assert_true(strtod(shb_shortest(DBL_TRUE_MIN, text), NULL) == DBL_TRUE_MIN);
}

static void short_ones_stay_short(void **state) {
  (void)state;
  char text[SHB_SHORTEST];
  assert_string_equal(shb_shortest(.3, text), "0.3");
  assert_string_equal(shb_shortest(-250, text), "-250");
  assert_string_equal(shb_shortest(0, text), "0");
  assert_string_equal(shb_shortest(2.1e11, text), "210000000000");
  assert_string_equal(shb_shortest(.1 + .2, text), "0.30000000000000004");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_come_back),
                                     cmocka_unit_test(short_ones_stay_short)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
