/* Refused designs: gathered by the key at fault, told once each. */
#include "cases/designs/refusals.h"

#include "tests/support/study_text.h"

static const char path[] = "folder/case.yaml";

static study_keys two_keys(void) {
  static double value[3] = {0.1, 0.2, 0.3};
  study_keys    keys     = {.n = 2};
  strcpy(keys.key[0].path, "contact.mu");
  keys.key[0].n     = 3;
  keys.key[0].value = value;
  strcpy(keys.key[1].path, "mesh.blade.sections[4].thickness");
  keys.key[1].is_range = true;
  return keys;
}

static void the_first_line_is_without_the_file(void **state) {
  (void)state;
  char out[64];
  refusal_line("folder/case.yaml:3:4: error: contact.mu: too large\n  3 | mu\n", path, out,
               sizeof out);
  assert_string_equal(out, "contact.mu: too large");
  refusal_line("folder/case.yaml: nothing\nmore", path, out, sizeof out);
  assert_has(out, "nothing");
  assert_null(strchr(out, '\n'));
  char cut[8];
  refusal_line("error: 0123456789", path, cut, sizeof cut);
  assert_string_equal(cut, "0123456");
}

static void refusals_are_gathered_by_key(void **state) {
  (void)state;
  const study_keys keys = two_keys();
  refusals         r    = {0};
  for (int d = 2; d < 6; d++)
    refusals_take(&r, &keys, d, "folder/case.yaml: error: contact.mu: too large\n", path);
  refusals_take(&r, &keys, 7, "folder/case.yaml: error: mesh.blade.sections[4].thickness: too thin",
                path);
  refusals_take(&r, &keys, 8, "folder/case.yaml: error: rotor.speed: none", path);
  refusals_take(&r, &keys, 9, "folder/case.yaml: error: rotor.blades: none", path);
  assert_int_equal(r.n_designs, 7);
  assert_int_equal(r.n, 4);
  assert_int_equal(r.told[0].key, 0);
  assert_int_equal(r.told[0].design, 2);
  assert_int_equal(r.told[0].n, 4);
  assert_string_equal(r.told[0].text, "contact.mu: too large");
  assert_int_equal(r.told[1].key, 1);
  assert_int_equal(r.told[2].key, -1);
  assert_int_equal(r.told[3].key, -1);
}

/* Another key whose name only begins the same is not at fault. */
static void longer_names_are_other_keys(void **state) {
  (void)state;
  const study_keys keys = two_keys();
  refusals         r    = {0};
  refusals_take(&r, &keys, 0, "folder/case.yaml: error: contact.mu_static: wrong", path);
  assert_int_equal(r.told[0].key, -1);
}

static void no_more_than_five_are_told(void **state) {
  (void)state;
  const study_keys keys       = two_keys();
  study_text       t          = study_text_parse("vary: {contact.mu: [0.1, 0.2, 0.3]}\n");
  const double     design[18] = {0.2};
  refusals         r          = {0};
  for (int d = 0; d < 9; d++) {
    char text[64];
    snprintf(text, sizeof text, "folder/case.yaml: error: rotor%d: none", d);
    refusals_take(&r, &keys, d, text, path);
  }
  assert_int_equal(r.n, REFUSALS_TOLD);
  assert_int_equal(r.n_designs, 9);
  refusals_report(&r, &keys, design, t.root, t.root, &t.issues);
  assert_int_equal(t.issues.n, REFUSALS_TOLD + 1);
  assert_has(t.issues.issue[REFUSALS_TOLD].text, "9 designs");
  study_text_free(&t);
}

/* The issue stands at the value of the list. */
static void a_refusal_is_told_at_its_value(void **state) {
  (void)state;
  const study_keys keys      = two_keys();
  study_text       t         = study_text_parse("vary:\n  contact.mu: [0.1, 0.2, 0.3]\n");
  const double     design[6] = {0.1, 0, 0.2, 0, 0.3, 0};
  refusals         r         = {0};
  for (int d = 1; d < 3; d++)
    refusals_take(&r, &keys, d, "folder/case.yaml: error: contact.mu: no", path);
  refusals_report(&r, &keys, design, t.root, t.root, &t.issues);
  study_text_check(&t, "design 2: contact.mu: no (2 designs in all)");
  assert_int_equal(t.issues.issue[0].line, 2);
  assert_int_equal(t.issues.issue[0].column, 21);
  study_text_free(&t);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_first_line_is_without_the_file),
      cmocka_unit_test(refusals_are_gathered_by_key),
      cmocka_unit_test(longer_names_are_other_keys),
      cmocka_unit_test(no_more_than_five_are_told),
      cmocka_unit_test(a_refusal_is_told_at_its_value),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
