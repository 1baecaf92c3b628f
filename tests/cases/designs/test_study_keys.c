/* Varied keys of a study: their values in SI, their ranges, what is no key. */
#include "cases/designs/study_keys.h"

#include "tests/support/study_text.h"

static study_keys read_keys(const char *text, const char *fault) {
  study_text t    = study_text_parse(text);
  study_keys keys = {0};
  study_keys_read(&t.issues, t.root, &keys);
  study_text_check(&t, fault);
  study_text_free(&t);
  return keys;
}

static void lists_are_read_in_si(void **state) {
  (void)state;
  char       name[STUDY_KEY_TEXT];
  study_keys k = read_keys(
      "contact.n0: [10 N, 0.25 kN]\ncontact.mu: [0.3]\n"
      "mesh.blade.sections[4].thickness: [5 mm]\n",
      NULL);
  assert_int_equal(k.n, 3);
  assert_int_equal(k.n_uncertain, 0);
  assert_string_equal(k.key[0].path, "contact.n0");
  assert_string_equal(k.key[0].unit, "N");
  assert_false(k.key[0].is_range);
  assert_int_equal(k.key[0].n, 2);
  assert_near(k.key[0].value[0], 10, 0);
  assert_near(k.key[0].value[1], 250, 1e-12);
  assert_near(k.key[2].value[0], 0.005, 1e-18);
  study_key_name(&k.key[2], name);
  assert_string_equal(name, "mesh.blade.sections[4].thickness");
  k.key[2].is_ratio = true;
  study_key_name(&k.key[2], name);
  assert_has(name, "thickness (ratio)");
  study_keys_free(&k);
  assert_int_equal(k.n, 0);
}

/* Points of a range are equally far apart, or in steps of equal ratio. */
static void ranges_have_their_points(void **state) {
  (void)state;
  study_keys k = read_keys(
      "contact.n0: {from: 10 N, to: 250 N, points: 4}\n"
      "contact.ku: {from: 1 N/m, to: 1000 N/m, points: 4, scale: log}\n"
      "contact.mu: {from: 0.1, to: 0.5}\n",
      NULL);
  assert_int_equal(k.n, 3);
  for (int i = 0; i < 4; i++) {
    assert_near(k.key[0].value[i], 10 + 80 * i, 1e-12);
    assert_within(k.key[1].value[i], pow(10, i), 1e-12);
  }
  assert_true(k.key[1].log && k.key[1].is_range && !k.key[0].log);
  assert_int_equal(k.key[2].n, 0);
  study_keys_free(&k);
}

/* study_key_at: equal shares of a list, both kinds of ranges, whole numbers. */
static void numbers_from_0_to_1_become_values(void **state) {
  (void)state;
  study_keys k = read_keys(
      "contact.n0: [1 N, 2 N, 5 N]\ncontact.mu: {from: 0.1, to: 0.5}\n"
      "contact.ku: {from: 1 N/m, to: 100 N/m, scale: log}\n",
      NULL);
  const double u[] = {1e-9, 0.33, 0.34, 0.66, 0.67, 1 - 1e-9}, wanted[] = {1, 1, 2, 2, 5, 5};
  for (int i = 0; i < 6; i++) assert_near(study_key_at(&k.key[0], u[i]), wanted[i], 0);
  assert_near(study_key_at(&k.key[1], 0.25), 0.2, 1e-15);
  assert_within(study_key_at(&k.key[2], 0.25), pow(10, 0.5), 1e-14);
  study_key whole = {.whole = true, .is_range = true, .from = 3, .to = 5};
  for (int i = 0; i < 3; i++) {
    assert_near(study_key_at(&whole, (i + 1e-9) / 3), 3 + i, 0);
    assert_near(study_key_at(&whole, (i + 1 - 1e-9) / 3), 3 + i, 0);
  }
  study_key uncertain = {.is_uncertain = true, .distribution = {PLAN_UNIFORM, {2, 4, 0, 0}}};
  assert_near(study_key_at(&uncertain, 0.75), 3.5, 1e-14);
  uncertain.whole = true;
  assert_near(study_key_at(&uncertain, 0.6), 3, 0);
  study_keys_free(&k);
}

static void what_is_no_key_or_no_value_is_told(void **state) {
  (void)state;
  static const char *const faults[][2] = {
      {"contact.mu: []", "contact.mu"},
      {"contact.muu: [0.3]", "contact.mu"},
      {"name: [a]", "name"},
      {"contact.n0: [10 m]", "contact.n0"},
      {"contact.mu: {from: 0.5, to: 0.1}", "from below to"},
      {"contact.mu: {from: 0, to: 0.1, scale: log}", "range above 0"},
      {"contact.mu: {from: 0.1, to: 0.5, points: 1}", "2 points"},
      {"contact.mu: {from: 0.1, to: 0.5, step: 2}", "step"},
      {"modal.modes: [2.5]", "whole numbers"},
  };
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
    study_keys k = read_keys(faults[i][0], faults[i][1]);
    study_keys_free(&k);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lists_are_read_in_si),
      cmocka_unit_test(ranges_have_their_points),
      cmocka_unit_test(numbers_from_0_to_1_become_values),
      cmocka_unit_test(what_is_no_key_or_no_value_is_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
