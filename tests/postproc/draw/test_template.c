/* A page from a template: values, parts that are there or not, and what is wrong with one. */
#include "postproc/draw/template.h"

#include "tests/support/check.h"

static void make(post_values_list *v) {
  *v = (post_values_list){0};
  post_put(post_value(v, "name"), "<b>");
  post_put(post_value(v, "list"), "1, 2");
  post_value(v, "none");
}

static void check(const char *text, const char *wanted) {
  post_values_list v;
  post_buffer      out = {0};
  make(&v);
  assert_ok(post_template(text, &v, &out));
  assert_string_equal(out.text, wanted);
  post_buffer_free(&out);
  post_values_list_free(&v);
}

static void values_and_parts(void **state) {
  (void)state;
  check("{ {{name}} } {{list}}.", "{ <b> } 1, 2.");
  check("{{#list}}of {{list}}{{/list}}{{#none}}not {{name}}{{/none}}|", "of 1, 2|");
  check("{{^none}}none{{/none}}{{^list}}empty{{/list}}|", "none|");
  check("{{#list}}a{{#none}}b{{#name}}c{{/name}}{{/none}}{{^none}}d{{/none}}{{/list}}|", "ad|");
}

static void fails(const char *text, const char *why) {
  post_values_list v;
  post_buffer      out = {0};
  make(&v);
  assert_int_equal(post_template(text, &v, &out), SHB_ERR_INPUT);
  assert_has(shb_message(), why);
  post_buffer_free(&out);
  post_values_list_free(&v);
}

static void faults_are_told(void **state) {
  (void)state;
  fails("{{nam}}", "{{nam}} has no value");
  fails("{{names}}", "{{names}} has no value");
  fails("{{#none}}{{other}}{{/none}}", "{{other}} has no value"); /* also where it is not shown */
  fails("{{#list}} ", "{{#list}} does not end");
  fails("{{#list}}{{/name}}", "{{/name}} ends another part");
  fails("{{list", "not closed");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(values_and_parts),
                                     cmocka_unit_test(faults_are_told)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
