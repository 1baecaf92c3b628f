/* STUDY.yaml: what is read, its designs, their words and digests, what is wrong with it. */
#include "cases/designs/study_spec.h"

#include "cases/schema/case.h"
#include "tests/support/study_file.h"

static const char grid[] =
    "vary:\n  contact.n0: [10 N, 20 N, 30 N]\n  contact.mu: [0.2, 0.4]\n"
    "plan: grid\noutputs: [peak, frequency]\n";

static void a_study_is_read_whole(void **state) {
  (void)state;
  study_spec s;
  study_file_read(grid, NULL, &s);
  assert_string_equal(s.name, "study");
  assert_int_equal(s.n_designs, 6);
  assert_int_equal(s.keys.n, 2);
  assert_int_equal(s.n_outputs, 2);
  assert_string_equal(s.output[1].name, "frequency");
  assert_false(s.optimise.wanted);
  for (int d = 0; d < 6; d++) {
    assert_near(s.design[2 * d], 10 * (1 + d / 2), 1e-12);
    for (int e = 0; e < d; e++) assert_string_not_equal(s.digest[d], s.digest[e]);
    assert_int_equal(strlen(s.digest[d]), DIGEST_TEXT - 1);
  }
  study_spec_free(&s);
  assert_null(s.design);
}

/* The words of a design are those that set the keys of its case. */
static void words_and_case_of_a_design(void **state) {
  (void)state;
  study_spec s;
  case_file  file;
  char      *words[4];
  char       digest[DIGEST_TEXT], why[256];
  study_file_read(grid, NULL, &s);
  const double *third = s.design + 2 * 3;
  assert_int_equal(study_spec_words(&s, third, words), 4);
  assert_string_equal(words[0], "--set");
  assert_has(words[1], "contact.n0=20");
  assert_has(words[3], "contact.mu=0.4");
  for (int i = 0; i < 4; i++) free(words[i]);
  assert_ok(study_spec_design(&s, third, "design", study_folder, stderr, &file));
  assert_near(file.mhb.n0[0], 20, 1e-12);
  assert_int_equal(file.mhb.n_preloads, 1);
  assert_near(file.mhb.mu, 0.4, 1e-15);
  case_free(&file);
  assert_true(study_spec_digest(&s, third, digest, why, sizeof why));
  assert_string_equal(digest, s.digest[3]);
  const double wrong[2] = {20, -3};
  assert_false(study_spec_digest(&s, wrong, digest, why, sizeof why));
  assert_string_equal(digest, "");
  assert_has(why, "contact.mu");
  study_spec_free(&s);
}

static void faults_are_told_at_their_place(void **state) {
  (void)state;
  static const char *const faults[][2] = {
      {"plan: grid\noutputs: [peak]\n", "vary"},
      {"vary: {contact.n0: [1 N]}\noutputs: [peak]\nplann: grid\n", "unknown key"},
      {"vary: {contact.n0: [1 N]}\noutputs: [peek]\n", "peek"},
      {"vary: {contact.n0: [1 N]}\noutputs: [peak]\nsamples: 16\n", "uncertain"},
      {"uncertain: {contact.mu: {uniform: [0.1, 0.3]}}\noutputs: [peak]\n", "needs samples"},
      {"vary: {contact.mu: [0.3, -2]}\noutputs: [peak]\n", "design 2: "},
      {"vary: {contact.n0: [1 N]}\noutputs: [peak]\nname: a/b\n", "cannot be a file name"},
      {"vary: {contact.n0: {from: 1 N, to: 2 N}}\nplan: grid\noptimise: {minimise: peak}\n",
       "makes its own designs"},
  };
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
    study_spec s;
    study_file_read(faults[i][0], faults[i][1], &s);
    study_spec_free(&s);
  }
}

static void a_missing_file_is_told(void **state) {
  (void)state;
  study_spec s;
  assert_int_equal(study_spec_read("/nowhere/study.yaml", true, stderr, &s), SHB_ERR_IO);
  assert_has(shb_message(), "/nowhere/study.yaml");
  study_spec_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_study_is_read_whole),
      cmocka_unit_test(words_and_case_of_a_design),
      cmocka_unit_test(faults_are_told_at_their_place),
      cmocka_unit_test(a_missing_file_is_told),
  };
  return cmocka_run_group_tests(tests, study_folder_make, study_folder_remove);
}
