/* Uncertain keys of a study: their distributions, and ratios to varied keys. */
#include "cases/designs/uncertain_keys.h"

#include "tests/support/study_text.h"

/* Uncertain keys beside a varied contact.n0. */
static study_keys read_keys(const char *text, const char *fault) {
  study_text varied = study_text_parse("contact.n0: [10 N, 20 N]"), t = study_text_parse(text);
  study_keys keys = {0};
  study_keys_read(&varied.issues, varied.root, &keys);
  study_text_check(&varied, NULL);
  uncertain_keys_read(&t.issues, t.root, &keys);
  study_text_check(&t, fault);
  study_text_free(&varied);
  study_text_free(&t);
  return keys;
}

static void distributions_are_read_in_si(void **state) {
  (void)state;
  study_keys k = read_keys(
      "contact.mu: {triangular: [0.2, 0.3, 0.5]}\n"
      "contact.ku: {lognormal: [0.5 MN/m, 50 kN/m]}\n"
      "contact.n0: {normal: [1, 0.1], relative: true}\n",
      NULL);
  assert_int_equal(k.n, 4);
  assert_int_equal(k.n_uncertain, 3);
  assert_false(k.key[0].is_uncertain);
  const study_key *mu = &k.key[1], *ku = &k.key[2], *n0 = &k.key[3];
  assert_int_equal(mu->distribution.kind, PLAN_TRIANGULAR);
  assert_near(mu->distribution.parameter[1], 0.3, 0);
  assert_true(mu->is_uncertain && !mu->is_ratio);
  assert_int_equal(mu->nominal, -1);
  assert_within(ku->distribution.parameter[0], 5e5, 1e-14);
  assert_within(ku->distribution.parameter[1], 5e4, 1e-14);
  assert_true(n0->is_ratio);
  assert_int_equal(n0->nominal, 0);
  assert_string_equal(n0->unit, "-");
  study_keys_free(&k);
}

static void faults_are_told(void **state) {
  (void)state;
  static const char *const faults[][2] = {
      {"contact.mu: 0.3", "distribution"},
      {"contact.mu: {gauss: [0.3, 0.1]}", "unknown distribution"},
      {"contact.mu: {normal: [0.3]}", "2 numbers"},
      {"contact.mu: {normal: [0.3, 0.1], uniform: [0, 1]}", "distribution"},
      {"contact.mu: {relative: false}", "distribution"},
      {"contact.mu: {uniform: [0.5, 0.1]}", "contact.mu"},
      {"contact.mu: {normal: [1, 0.1], relative: true}", "vary"},
      {"contact.n0: {normal: [10 N, 1 N]}", "relative: true"},
      {"contact.mu: {normal: [1, 0.1], relative: 3}", "true or false"},
  };
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
    study_keys k = read_keys(faults[i][0], faults[i][1]);
    study_keys_free(&k);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(distributions_are_read_in_si),
      cmocka_unit_test(faults_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
