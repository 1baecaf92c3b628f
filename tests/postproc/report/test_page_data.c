/* The JSON of the page: members, the numbers behind base64, what is left out of large responses. */
#include "postproc/report/page_data.h"

#include "postproc/analysis/stability_findings.h"

#include "tests/support/check.h"
#include "tests/support/fixture.h"

static char *data_of(mhb_response *r, int *left_out) {
  post_analysis *analysis;
  post_buffer    out = {0};
  assert_non_null(r);
  assert_ok(post_analysis_create(r, &analysis));
  assert_ok(post_page_data(analysis, 0, NULL, &out, left_out));
  assert_false(out.failed);
  post_analysis_destroy(analysis);
  return out.text;
}

static int digit(char c) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  return (int)(strchr(digits, c) - digits);
}

/* Float number i of base64 text on a little-endian machine. */
static float float_at(const char *text, size_t i) {
  unsigned char bytes[4];
  for (size_t b = 0; b < 4; b++) {
    const size_t bit = 8 * (4 * i + b), at = bit / 6, shift = bit % 6;
    bytes[b] = (unsigned char)((digit(text[at]) << 6 | digit(text[at + 1])) >> (4 - shift));
  }
  float value;
  memcpy(&value, bytes, sizeof value);
  return value;
}

/* Braces and brackets close in order outside of strings. */
static void check_brackets(const char *c) {
  char open[64];
  int  depth = 0;
  for (; *c; c++) {
    if (*c == '"')
      for (c++; *c != '"'; c++)
        if (*c == '\\') c++;
    if (*c == '{' || *c == '[') open[depth++] = *c;
    if (*c == '}' || *c == ']') assert_int_equal(open[--depth], *c == '}' ? '{' : '[');
    assert_in_range(depth, 0, 63);
  }
  assert_int_equal(depth, 0);
}

/* The first branch has all its 240 points; its first row is the frequency. */
static void numbers_are_those_of_the_response(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  mhb_response   *r = fixture_response(&o);
  int             left_out;
  char           *text = data_of(r, &left_out);
  check_brackets(text);
  assert_int_equal(left_out, 0);
  static const char *const members[] = {"\"format\":\"shroudhb report page\",\"version\":1",
                                        "\"abscissa\":0",
                                        "\"stability\":6",
                                        "\"rows\":",
                                        "\"chosen\":0",
                                        "\"abscissa\":{",
                                        "\"groups\":[",
                                        "\"outputs\":[",
                                        "\"spectra\":[",
                                        "\"branches\":[",
                                        "\"parameter\":\"frequency\""};
  for (size_t i = 0; i < sizeof members / sizeof *members; i++) assert_has(text, members[i]);
  const char *branch = strstr(text, "\"branches\":[");
  assert_has(branch, "\"n\":240,");
  const char *data = strstr(branch, "\"data\":\"") + strlen("\"data\":\"");
  for (size_t i = 0; i < 240; i += 13)
    assert_near(float_at(data, i), r->branch[0].frequency[i], 1e-5);
  for (size_t i = 0; i < 240; i += 13)
    assert_near(float_at(data, 6 * 240 + i), post_verdict_of(&r->branch[0], (int)i), 0);
  free(text);
  mhb_response_destroy(r);
}

/* More points than fit: thinned, columns left out, and never above the limit of 2.3 MB. */
static void large_responses_are_cut(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  o.n_points        = 6000;
  mhb_response *r   = fixture_response(&o);
  int           left_out;
  char         *text = data_of(r, &left_out);
  assert_true(left_out > 0);
  assert_true(strlen(text) < 2300000);
  free(text);
  mhb_response_destroy(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_are_those_of_the_response),
                                     cmocka_unit_test(large_responses_are_cut)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
