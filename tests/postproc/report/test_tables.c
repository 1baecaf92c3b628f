/* Tables of the report: a row for each peak, curve, mode and setting; texts are escaped. */
#include "postproc/report/tables.h"

#include "tests/support/check.h"
#include "tests/support/fixture.h"

static int count(const char *text, const char *part) {
  int n = 0;
  for (; (text = strstr(text, part)); text += strlen(part)) n++;
  return n;
}

static void settings_are_escaped(void **state) {
  (void)state;
  post_buffer out = {0};
  post_table_settings("contact.mu = 0.3 <&>\nname = a = b\n", &out);
  assert_has(out.text, "<code>contact.mu</code></th><td class=\"words\">0.3 &lt;&amp;&gt;</td>");
  assert_has(out.text, "<code>name</code></th><td class=\"words\">a = b</td>");
  assert_int_equal(count(out.text, "<tr>"), 2);
  post_buffer_free(&out);
  out = (post_buffer){0};
  post_table_settings("contact.mu = 0.29999999999999999 12345678901234567\n", &out);
  assert_has(out.text, ">0.3 12345678901234568<");
  post_buffer_free(&out);
  post_table_settings("", &out);
  assert_string_equal(out.text, "<p>The response file holds no settings.</p>\n");
  post_buffer_free(&out);
}

static void modes_are_listed(void **state) {
  (void)state;
  fixture_options o   = fixture_usual();
  mhb_response   *r   = fixture_response(&o);
  post_buffer     out = {0};
  assert_non_null(r);
  post_table_modes(r, &out);
  assert_int_equal(count(out.text, "<tr><th scope=\"row\">"), r->n_modes);
  assert_has(out.text, "with its shrouds free.</caption>");
  post_buffer_free(&out);
  r->n_modes = 0;
  post_table_modes(r, &out);
  assert_has(out.text, "does not list the modes");
  post_buffer_free(&out);
  mhb_response_destroy(r);
}

/* A row of quality for each curve with its verdict; a row for each peak and fold. */
static void curves_are_listed(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  mhb_response   *r = fixture_response(&o);
  post_analysis  *analysis;
  post_buffer     quality = {0}, peaks = {0};
  int             rows = 0;
  assert_ok(post_analysis_create(r, &analysis));
  post_table_quality(analysis, &quality);
  post_table_peaks(analysis, &peaks);
  assert_int_equal(count(quality.text, "<tr><th scope=\"row\">"), r->n_branches);
  assert_int_equal(count(quality.text, "<td class=\"good\">linear</td>"), 2);
  assert_int_equal(count(quality.text, "<td class=\"bad\">incomplete</td>"), 1);
  for (int b = 0; b < r->n_branches; b++)
    rows += analysis->curve[b].n_peaks + analysis->curve[b].n_folds;
  assert_int_equal(count(peaks.text, "<tr><th scope=\"row\">"), rows);
  assert_int_equal(count(peaks.text, "fold, sweeping "), 10);
  post_buffer_free(&quality);
  post_buffer_free(&peaks);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(settings_are_escaped),
                                     cmocka_unit_test(modes_are_listed),
                                     cmocka_unit_test(curves_are_listed)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
