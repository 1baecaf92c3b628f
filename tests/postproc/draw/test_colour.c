/* The colour ramp of the preloads: lightness, contrast, style rules. */
#include "postproc/draw/colour.h"

#include "tests/support/check.h"

/* Relative luminance of "#rrggbb" (WCAG 2). */
static double luminance(const char *hex) {
  static const double weight[] = {0.2126, 0.7152, 0.0722};
  double              sum      = 0;
  for (int i = 0; i < 3; i++) {
    char   part[3] = {hex[1 + 2 * i], hex[2 + 2 * i], '\0'};
    double v       = (double)strtol(part, NULL, 16) / 255;
    sum += weight[i] * (v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4));
  }
  return sum;
}

/* Lightness falls along the ramp. The contrast to the page is at least 2 to 1 (light) and 3 to 1
 * (dark). */
static void lightness_falls(void **state) {
  (void)state;
  for (int dark = 0; dark <= 1; dark++) {
    double last = 2;
    for (int i = 0; i <= 40; i++) {
      char colour[8];
      post_colour(i / 40.0, dark, colour);
      double y = luminance(colour);
      assert_true(y < last + 2e-3);
      last = y;
      assert_true(dark ? (y + 0.05) / (luminance("#171e25") + 0.05) > 3
                       : (luminance("#fffefb") + 0.05) / (y + 0.05) > 2);
    }
  }
}

/* The classes c0 .. c2 have the colours at 0, 1/2 and 1; a single class has that of the middle. */
static void rules_name_the_colours(void **state) {
  (void)state;
  for (int dark = 0; dark <= 1; dark++) {
    char        colour[3][8], wanted[80];
    post_buffer three = {0}, one = {0};
    for (int i = 0; i < 3; i++) post_colour(i / 2.0, dark, colour[i]);
    post_put_ramp(3, dark, &three);
    post_put_ramp(1, dark, &one);
    snprintf(wanted, sizeof wanted, ".c0{color:%s}.c1{color:%s}.c2{color:%s}", colour[0], colour[1],
             colour[2]);
    assert_string_equal(three.text, wanted);
    snprintf(wanted, sizeof wanted, ".c0{color:%s}", colour[1]);
    assert_string_equal(one.text, wanted);
    post_buffer_free(&three);
    post_buffer_free(&one);
  }
}

/* Outside 0 .. 1 the colour is that of the end. */
static void ends_are_limits(void **state) {
  (void)state;
  char inside[8], outside[8];
  post_colour(0, false, inside);
  post_colour(-3, false, outside);
  assert_string_equal(inside, outside);
  post_colour(1, false, inside);
  post_colour(1.7, false, outside);
  assert_string_equal(inside, outside);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(lightness_falls),
                                     cmocka_unit_test(rules_name_the_colours),
                                     cmocka_unit_test(ends_are_limits)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
