/* Reproducible random numbers: the known sequence of splitmix64, and the moments of a uniform
 * one. */
#include "modal/common/random_vector.h"

#include "tests/support/check.h"

/* The first outputs of splitmix64 from state 0 (Steele, Lea, Flood 2014), top 53 bits in [-1,
 * 1). */
static void first_numbers_are_known(void **state) {
  (void)state;
  const uint64_t known[3] = {0xe220a8397b1dcdafu, 0x6e789e6aa1b965f4u, 0x06c45d188009454fu};
  for (uint64_t key = 0; key < 3; key++)
    assert_near(modal_random(key), (double)(known[key] >> 11) * 0x1p-52 - 1, 0);
}

/* Mean 0, variance 1/3, no correlation with the neighbour or with alternating signs, each within
 * five standard deviations of its estimate. */
static void numbers_are_uniform(void **state) {
  (void)state;
  enum { N = 200000 };
  double mean = 0, square = 0, neighbour = 0, alternating = 0, last = 0;
  for (uint64_t key = 0; key < N; key++) {
    const double x = modal_random(key);
    assert_true(x >= -1 && x < 1);
    mean += x / N;
    square += x * x / N;
    neighbour += x * last / N;
    alternating += (key % 2 ? x : -x) / N;
    last = x;
  }
  assert_near(mean, 0, 5 * sqrt(1 / 3. / N));
  assert_near(alternating, 0, 5 * sqrt(1 / 3. / N));
  assert_near(square, 1 / 3., 5 * sqrt(4 / 45. / N));
  assert_near(neighbour, 0, 5 * sqrt(1 / 9. / N));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(first_numbers_are_known),
                                     cmocka_unit_test(numbers_are_uniform)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
