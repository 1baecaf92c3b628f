#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "cases/parse/units.h"
#include "mesh/base/constants.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* Powers of ten do not round: the value is the double that the plain number gives. */
static void powers_of_ten_are_exact(void **state) {
  (void)state;
  static const struct {
    const char *text, *unit;
    double      value;
  } rows[] = {{"0.2 mm", "m", 0.0002},
              {"0.2mm", "m", 0.0002},
              {"7.85 g/cm3", "kg/m3", 7850},
              {"7.85 g/cm^3", "kg/m3", 7850},
              {"7.85 t/m3", "kg/m3", 7850},
              {"7850 kg/m3", "kg/m3", 7850},
              {"2 MN/m", "N/m", 2e6},
              {"2.7 N/mm", "N/m", 2700},
              {"0.37 kN/mm", "N/m", 370000},
              {"3.1 GN/m", "N/m", 3.1e9},
              {"210 GPa", "Pa", 210e9},
              {"207000 MPa", "Pa", 207e9},
              {"207e3 N/mm2", "Pa", 207e9},
              {"200 Pa", "Pa", 200},
              {"3 bar", "Pa", 3e5},
              {"17 mbar", "Pa", 1700},
              {"100 Hz", "Hz", 100},
              {"100Hz", "Hz", 100},
              {"1.5 kHz", "Hz", 1500},
              {"3 1/s", "Hz", 3},
              {"0.3 %", "", 0.003},
              {"0.31", "", 0.31},
              {"+0.31", "", 0.31},
              {".31", "", 0.31},
              {"31.", "", 31},
              {"-31e-2", "", -0.31},
              {"3.1E1 um", "m", 3.1e-5},
              {"31 \u00B5m", "m", 3.1e-5},
              {"31 \u03BCm", "m", 3.1e-5},
              {"47 nm", "m", 47e-9},
              {"4.7 cm", "m", 0.047},
              {"0.47", "m", 0.47},
              {"100 N", "N", 100},
              {"1.1 kN", "N", 1100},
              {"3 mN", "N", 0.003},
              {"2 rad", "rad", 2},
              {"20 mrad", "rad", 0.02},
              {"100 rad/s", "rad/s", 100},
              {"2 kg*m/s2", "N", 2},
              {"-1e-100 m", "m", -1e-100},
              {"0e-320 m", "m", 0}};
  for (size_t i = 0; i < COUNT(rows); i++) {
    double value         = -1;
    char   why[CASE_WHY] = "";
    if (!case_quantity(rows[i].text, rows[i].unit, &value, why))
      fail_msg("%s: %s", rows[i].text, why);
    if (value != rows[i].value)
      fail_msg("%s: %.17g, expected %.17g", rows[i].text, value, rows[i].value);
  }
}

static void angles_and_turns(void **state) {
  (void)state;
  const struct {
    const char *text, *unit;
    double      value;
  } rows[] = {{"35 deg", "rad", 35 * SHB_PI / 180}, {"35\u00B0", "rad", 35 * SHB_PI / 180},
              {"-90 deg", "rad", -SHB_PI / 2},      {"6000 rpm", "rad/s", 200 * SHB_PI},
              {"50 rev/s", "rad/s", 100 * SHB_PI},  {"360 deg/s", "rad/s", SHB_TWO_PI}};
  for (size_t i = 0; i < COUNT(rows); i++) {
    double value = -1;
    char   why[CASE_WHY];
    assert_true(case_quantity(rows[i].text, rows[i].unit, &value, why));
    assert_true(fabs(value - rows[i].value) <= 4e-16 * fabs(rows[i].value));
  }
}

static void refuses(void **state) {
  (void)state;
  static const struct {
    const char *text, *unit, *says;
  } rows[] = {{"", "m", "is not a number"},
              {" ", "m", "is not a number"},
              {"m", "m", "is not a number"},
              {"0,3", "", "write 0.3 with a decimal point"},
              {"0,3 N", "N", "write 0.3 N with a decimal point"},
              {"1,000,000", "N", "is not a number"},
              {"1_000", "", "is not a number"},
              {"nan", "", "is not a number"},
              {"NaN", "N/m", "is not a number"},
              {"inf", "", "is not a number"},
              {"-inf N", "N", "is not a number"},
              {".inf", "", "is not a number"},
              {"infinity", "", "is not a number"},
              {"0x10", "", "is not a number"},
              {"0x1p3 m", "m", "is not a number"},
              {"1.2.3", "", "is not a number"},
              {"1-2", "", "is not a number"},
              {"--1", "", "is not a number"},
              {"+ 1", "", "is not a number"},
              {".", "", "is not a number"},
              {"e5", "", "is not a number"},
              {"1e", "", "unknown unit 'e'"},
              {"1 2", "m", "is not a number"},
              {"100 Hx", "Hz", "unknown unit 'Hx'; expected Hz"},
              {"100 hz", "Hz", "unknown unit 'hz'; expected Hz"},
              {"100 Hz Hz", "Hz", "unknown unit"},
              {"100 Hz", "N/m", "has unit Hz, expected N/m"},
              {"100 rpm", "Hz", "has unit rpm, expected Hz"},
              {"50 Hz", "rad/s", "has unit Hz, expected rad/s"},
              {"3 N", "N/m", "has unit N, expected N/m"},
              {"3 N/m2", "N/m", "has unit N/m2, expected N/m"},
              {"7 deg", "", "has unit deg, expected a number without a unit"},
              {"3 mm2", "m", "has unit mm2, expected m"},
              {"3 kdeg", "rad", "unknown unit 'kdeg'"},
              {"3 Mm", "m", "unknown unit 'Mm'"},
              {"3 N/", "N", "unknown unit 'N/'"},
              {"3 /m", "m", "unknown unit '/m'"},
              {"3 N//m", "N/m", "unknown unit 'N//m'"},
              {"3 m^", "m", "unknown unit 'm^'"},
              {"3 m0", "m", "unknown unit 'm0'"},
              {"1e400", "", "out of the range"},
              {"1e99999999999999999999", "", "out of the range"},
              {"1e-400", "", "out of the range"},
              {"1e-308", "", "too small to compute with"},
              {"-5e-324 m", "m", "too small to compute with"},
              {"9e-99 cm", "m", "too small to compute with"},
              {"1e308 kN", "N", "out of the range"},
              {"1e308 rev", "rad", "out of the range"}};
  for (size_t i = 0; i < COUNT(rows); i++) {
    double value         = -1;
    char   why[CASE_WHY] = "";
    if (case_quantity(rows[i].text, rows[i].unit, &value, why))
      fail_msg("'%s' was read as %g", rows[i].text, value);
    if (!strstr(why, rows[i].says)) fail_msg("'%s': %s", rows[i].text, why);
    assert_null(strchr(why, '\n'));
  }
}

static void long_text_is_cut(void **state) {
  (void)state;
  char text[5000], why[CASE_WHY];
  memset(text, '9', sizeof text);
  text[sizeof text - 1] = '\0';
  double value;
  assert_false(case_quantity(text, "m", &value, why));
  assert_true(strlen(why) < CASE_WHY);
  memset(text, 'm', sizeof text - 1);
  text[0] = '1';
  assert_false(case_quantity(text, "m", &value, why));
}

static void integers(void **state) {
  (void)state;
  int  value;
  char why[CASE_WHY];
  assert_true(case_integer("37", &value, why));
  assert_int_equal(value, 37);
  assert_true(case_integer("-12", &value, why));
  assert_int_equal(value, -12);
  static const char *const bad[] = {
      "",  "3.0", "3 ", " 3", "0x3", "3e1", "three", "2147483648", "99999999999999999999",
      "-", "3,0"};
  for (size_t i = 0; i < COUNT(bad); i++) assert_false(case_integer(bad[i], &value, why));
  assert_false(case_integer("auto", &value, why));
  assert_string_equal(why, "auto is not available; give a number");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(powers_of_ten_are_exact), cmocka_unit_test(angles_and_turns),
      cmocka_unit_test(refuses), cmocka_unit_test(long_text_is_cut), cmocka_unit_test(integers)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
