#include "postproc/draw/text_buffer.h"
#include "tests/support/check.h"

static void escaping(void **state) {
  (void)state;
  post_buffer b = {0};
  post_put_escaped(&b, "<a href=\"x\" b='y'>&amp;</a>\r\n\tω² 叶 \xf0\x9f\x94\xa7");
  assert_string_equal(
      b.text,
      "&lt;a href=&quot;x&quot; b=&#39;y&#39;&gt;&amp;amp;&lt;/a&gt;\n\tω² 叶 \xf0\x9f\x94\xa7");
  post_buffer_free(&b);
  /* a lone byte, a cut sequence, an overlong slash, a surrogate, beyond U+10FFFF, escape, a lone
   * CR */
  post_put_escaped(&b, "\xff|\xe2\x82|\xc0\xaf|\xed\xa0\x80|\xf4\x90\x80\x80|\x1b|\r|");
  const char *c        = b.text;
  int         replaced = 0;
  for (; (c = strstr(c, "\xef\xbf\xbd")); c += 3) replaced++;
  assert_int_equal(replaced, 1 + 2 + 2 + 3 + 4 + 1 + 1);
  assert_null(strpbrk(b.text, "\x1b\r"));
  post_buffer_free(&b);
}

static void json(void **state) {
  (void)state;
  post_buffer b = {0};
  post_put_json(&b, "</script>\"\\\n\t\x01µ\xff");
  assert_string_equal(b.text, "\"\\u003c/script>\\\"\\\\\\u000a\\u0009\\u0001µ\xef\xbf\xbd\"");
  post_buffer_free(&b);
}

static void base64(void **state) {
  (void)state;
  post_buffer b = {0};
  post_put_base64(&b, 1, (const float[]){1.0f}); /* 00 00 80 3f */
  assert_string_equal(b.text, "AACAPw==");
  post_buffer_free(&b);
  post_put_base64(&b, 3, (const float[]){1.0f, -2.5f, 103.6f}); /* 12 bytes, no padding */
  assert_string_equal(b.text, "AACAPwAAIMAzM89C");
  post_buffer_free(&b);
}

static void growth(void **state) {
  (void)state;
  post_buffer b = {0};
  for (int i = 0; i < 20000; i++) post_put(&b, "%d,", i % 10);
  assert_int_equal(b.length, 40000);
  assert_int_equal(strlen(b.text), 40000);
  assert_int_equal(b.text[39998], '9');
  post_buffer_free(&b);
  post_put_printable(&b, "a\x1b[31m\tb\x7f");
  assert_string_equal(b.text, "a?[31m\tb?");
  post_buffer_free(&b);
}

static void publishing(void **state) {
  (void)state;
  post_buffer b = {0};
  post_put(&b, "text");
  assert_int_equal(post_buffer_publish(&b, "no/such/folder/x.html"), SHB_ERR_IO);
  assert_has(shb_message(), "no/such/folder/x.html");
  b.failed = true;
  assert_int_equal(post_buffer_publish(&b, "x.html"), SHB_ERR_IO);
  assert_has(shb_message(), "memory");
  post_buffer_free(&b);
}

static void a_cell_is_no_formula(void **state) {
  (void)state;
  static const struct {
    const char *text, *cell;
  } row[] = {{"tip", "tip"},
             {"-5", "-5"},
             {"+1.5e-3", "+1.5e-3"},
             {"=1+2", "'=1+2"},
             {"-5+cmd", "'-5+cmd"},
             {"-inf", "'-inf"},
             {"-0x10", "'-0x10"},
             {"@SUM(A1)", "'@SUM(A1)"},
             {"+A1,B1", "\"'+A1,B1\""},
             {"-", "'-"},
             {"a=b", "a=b"},
             {"say \"x\"", "\"say \"\"x\"\"\""},
             {"\t=1", "?=1"},
             {"\r\n", "\"?\n\""},
             {"\x1b[31m", "?[31m"}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    post_buffer out = {0};
    post_put_csv(&out, row[i].text);
    assert_string_equal(out.text, row[i].cell);
    post_buffer_free(&out);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(escaping),   cmocka_unit_test(json),
      cmocka_unit_test(base64),     cmocka_unit_test(growth),
      cmocka_unit_test(publishing), cmocka_unit_test(a_cell_is_no_formula)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
