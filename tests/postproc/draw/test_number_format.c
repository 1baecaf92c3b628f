#include "postproc/draw/number_format.h"
#include "tests/support/check.h"

static void numbers(void **state) {
  (void)state;
  static const struct {
    double      value;
    int         digits;
    const char *number, *plain;
  } row[] = {
      {113.2, 2, "110", "110"},
      {1000, 3, "1000", "1000"},
      {0.0123456, 3, "0.0123", "0.0123"},
      {100, 5, "100.00", "100"},
      {-4.5, 2, "−4.5", "−4.5"},
      {1.2e-5, 2, "1.2×10⁻⁵", "1.2×10⁻⁵"},
      {3e7, 3, "3.00×10⁷", "3×10⁷"},
      {0, 4, "0", "0"},
      {NAN, 3, "–", "–"},
      {-INFINITY, 3, "–", "–"},
      {999.96, 4, "1000", "1000"},
      {123456, 7, "123456.0", "123456"},
      {9.9996e-5, 4, "0.0001000", "0.0001"},
      {1e-120, 2, "1.0×10⁻¹²⁰", "1×10⁻¹²⁰"},
  };
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    char out[POST_NUMBER];
    assert_string_equal(post_number(out, row[i].value, row[i].digits), row[i].number);
    assert_string_equal(post_plain(out, row[i].value, row[i].digits), row[i].plain);
  }
}

static void units(void **state) {
  (void)state;
  char out[POST_NUMBER];
  assert_string_equal(post_unit_length(0.0123).name, "mm");
  assert_string_equal(post_unit_length(-2.385e-4).name, "µm");
  assert_string_equal(post_unit_length(9.998e-4).name, "mm"); /* reads 1.000 mm, not 999.8 µm */
  assert_string_equal(post_unit_length(9.98e-4).name, "µm");
  assert_string_equal(post_unit_length(0).name, "µm");
  assert_string_equal(post_unit_length(NAN).name, "µm");
  assert_string_equal(post_unit_length(1e-15).name, "pm");
  assert_string_equal(post_unit_force(3000).name, "N");
  assert_string_equal(post_unit_force(30000).name, "kN");
  assert_string_equal(post_unit_stiffness(5e5).name, "kN/m");
  assert_string_equal(post_unit_stiffness(0).name, "MN/m");
  assert_string_equal(post_unit_energy(0.0256).name, "mJ");
  assert_string_equal(post_measure(out, 2.387e-4, post_unit_length(2.387e-4), 3), "239\u00a0µm");
  assert_string_equal(post_measure(out, NAN, post_unit_length(1), 3), "–");
  assert_string_equal(post_percent(out, 0.7149), "71\u00a0%");
  assert_string_equal(post_percent(out, 0.000344), "0.034\u00a0%");
  assert_string_equal(post_percent(out, 1.234), "123\u00a0%");
  assert_string_equal(post_power(out, 1e-8), "10⁻⁸");
  assert_string_equal(post_power(out, 9.9999999999e-13), "10⁻¹²");
  assert_string_equal(post_power(out, 0.1), "0.1");
  assert_string_equal(post_power(out, 2e-3), "0.002");
  assert_string_equal(post_power(out, 0), "0");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(numbers), cmocka_unit_test(units)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
