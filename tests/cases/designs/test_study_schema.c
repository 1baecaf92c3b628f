/* The schema of STUDY.yaml: JSON that has every key of a study. */
#include "cases/designs/study_schema.h"

#include "tests/support/check.h"
#include "tests/support/json_syntax.h"

static void it_is_json_with_all_keys(void **state) {
  (void)state;
  static const char *const keys[] = {
      "\"case\"",    "\"vary\"",     "\"plan\"",      "\"uncertain\"", "\"samples\"",
      "\"outputs\"", "\"optimise\"", "\"name\"",      "\"seed\"",      "contact",
      "thickness",   "\"sobol\"",    "\"lognormal\"", "\"sbplx\""};
  char  *text = NULL;
  size_t size = 0;
  FILE  *out  = open_memstream(&text, &size);
  assert_non_null(out);
  study_print_schema(out);
  fclose(out);
  const char *end = json_value(text);
  assert_non_null(end);
  assert_int_equal(*json_blank(end), '\0');
  for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) assert_has(text, keys[i]);
  print_message("%zu bytes\n", size);
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(it_is_json_with_all_keys)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
