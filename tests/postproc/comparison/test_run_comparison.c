/* Two runs: curves of the same preload, peaks that change, settings that differ, page and JSON. */
#include "postproc/comparison/run_comparison.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "postproc/comparison/comparison_page.h"
#include "postproc/comparison/comparison_text.h"
#include "tests/support/check.h"
#include "tests/support/fixture.h"

static char path[2][256];

static int make_folder(void **state) {
  (void)state;
  static char folder[] = "/tmp/shroudhb-comparison-XXXXXX";
  if (!mkdtemp(folder)) return -1;
  for (int i = 0; i < 2; i++) snprintf(path[i], sizeof path[i], "%s/%d.response.h5", folder, i);
  return 0;
}

static int remove_folder(void **state) {
  (void)state;
  char command[300];
  snprintf(command, sizeof command, "rm -r %.*s", (int)(strrchr(path[0], '/') - path[0]), path[0]);
  return system(command);
}

static void write_run(int run, int n, const double *n0, double scale, const char *settings) {
  const shb_provenance provenance = {"case.yaml", "", settings, "shroudhb-mhb"};
  fixture_options      o          = fixture_usual();
  o.n_preloads                    = n;
  o.n0                            = n0;
  o.scale                         = scale;
  o.incomplete                    = false;
  mhb_response *r                 = fixture_response(&o);
  assert_non_null(r);
  assert_ok(mhb_response_write(r, path[run], &provenance));
  mhb_response_destroy(r);
}

static shb_status compare(post_comparison *c) {
  return post_comparison_read((const char *[]){path[0], path[1]}, (const char *[]){"one", "<two>"},
                              c);
}

static void curves_and_settings_are_matched(void **state) {
  (void)state;
  static const double first[] = {20, 100, 300}, second[] = {400, 100, 20};
  static const char  *key[] = {"b", "d", "e"}, *value[][2] = {{"2", "3"}, {"5", NULL}, {NULL, "6"}};
  static const double n0[] = {20, 100, 300, 400};
  post_comparison     c;
  fixture_options     o = fixture_usual();
  write_run(0, 3, first, o.scale, "a = 1\nb = 2\nc = x y\nd = 5\n");
  write_run(1, 3, second, 2 * o.scale, "a = 1\nb = 3\nc = x y\ne = 6\n");
  assert_ok(compare(&c));
  assert_int_equal(c.n_pairs, 6); /* open, stuck, 20, 100, 300, 400 */
  assert_int_equal(c.pair[0].kind, MHB_BRANCH_OPEN);
  assert_int_equal(c.pair[1].kind, MHB_BRANCH_STUCK);
  assert_near(post_change(&c.pair[0], false), 1, 1e-9);
  assert_near(post_change(&c.pair[0], true), 0, 1e-9);
  for (int i = 0; i < 4; i++) {
    assert_near(c.pair[i + 2].n0, n0[i], 0);
    assert_int_equal(c.pair[i + 2].rank, i);
    assert_true(isnan(post_change(&c.pair[i + 2], false)) == (i >= 2));
  }
  assert_int_equal(c.n_differences, 3);
  for (int i = 0; i < 3; i++) {
    assert_string_equal(c.difference[i].key, key[i]);
    for (int run = 0; run < 2; run++) {
      if (!value[i][run]) assert_null(c.difference[i].value[run]);
      if (value[i][run]) assert_string_equal(c.difference[i].value[run], value[i][run]);
    }
  }
  post_comparison_free(&c);
}

static void page_and_text(void **state) {
  (void)state;
  static const double n0[] = {20, 100};
  post_comparison     c;
  post_buffer         page = {0}, text = {0}, json = {0};
  fixture_options     o = fixture_usual();
  write_run(0, 2, n0, o.scale, "a = <i>\n");
  write_run(1, 2, n0, 1.5 * o.scale, "a = 2\n");
  assert_ok(compare(&c));
  post_comparison_page(&c, &page);
  post_comparison_text(&c, &text);
  post_comparison_json(&c, &json);
  assert_null(strstr(page.text, "<two>"));
  assert_null(strstr(page.text, "<i>"));
  assert_non_null(strstr(page.text, "&lt;two&gt;"));
  assert_non_null(strstr(page.text, "line c1 second"));
  assert_non_null(strstr(page.text, "<td>+50"));
  assert_non_null(strstr(text.text, "amplitude +50 %"));
  assert_non_null(strstr(text.text, "1 settings differ:\n  a: <i>, 2\n"));
  assert_non_null(strstr(json.text, "\"first\": \"one\""));
  assert_non_null(strstr(json.text, "\"amplitude_change\": "));
  post_buffer_free(&page);
  post_buffer_free(&text);
  post_buffer_free(&json);
  post_comparison_free(&c);
}

static void runs_over_other_parameters_are_refused(void **state) {
  (void)state;
  static const double  n0[]       = {20};
  const shb_provenance provenance = {"case.yaml", "", "", "shroudhb-mhb"};
  post_comparison      c;
  fixture_options      o = fixture_usual();
  write_run(0, 1, n0, o.scale, "");
  o.n_preloads    = 1;
  o.n0            = n0;
  o.limits        = false;
  o.parameter     = MHB_IN_MU;
  mhb_response *r = fixture_response(&o);
  assert_ok(mhb_response_write(r, path[1], &provenance));
  mhb_response_destroy(r);
  assert_int_equal(compare(&c), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "there is nothing to compare"));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(curves_and_settings_are_matched),
                                     cmocka_unit_test(page_and_text),
                                     cmocka_unit_test(runs_over_other_parameters_are_refused)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
