/* The stand-alone picture: one SVG with its own style, a legend entry for each group. */
#include "postproc/report/picture.h"

#include "tests/support/check.h"
#include "tests/support/fixture.h"

static char *picture_of(const fixture_options *o, const char *name) {
  mhb_response  *r = fixture_response(o);
  post_analysis *analysis;
  post_buffer    out = {0};
  assert_non_null(r);
  assert_ok(post_analysis_create(r, &analysis));
  post_picture(analysis, name, &out);
  assert_false(out.failed);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
  return out.text;
}

static void groups_are_named(void **state) {
  (void)state;
  fixture_options o   = fixture_usual();
  char           *svg = picture_of(&o, "z <notch>");
  assert_int_equal(strncmp(svg, "<?xml", 5), 0);
  assert_int_equal(strcmp(svg + strlen(svg) - 7, "</svg>\n"), 0);
  assert_has(svg, "Forced response of z &lt;notch&gt;</text>");
  assert_has(svg, ">100\u00a0N</text>");
  assert_has(svg, ">fully open</text>");
  assert_has(svg, ">fully stuck</text>");
  assert_has(svg, ">never seen</text>");
  for (int i = 0; i < o.n_preloads; i++) {
    char rule[32];
    snprintf(rule, sizeof rule, ".c%d{color:#", i);
    assert_has(svg, rule);
  }
  assert_has_not(svg, "href");
  assert_has_not(svg, "nan");
  free(svg);
}

/* Legend entries appear only for what is drawn. */
static void legend_holds_what_is_drawn(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  o.limits          = false;
  char *svg         = picture_of(&o, "plain");
  assert_has_not(svg, ">fully open</text>");
  assert_has_not(svg, ">time integration</text>");
  free(svg);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(groups_are_named),
                                     cmocka_unit_test(legend_holds_what_is_drawn)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
