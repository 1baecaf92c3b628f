/* The keys of a study file: their table, their defaults, and overrides. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/study_file.h"

/* Rows are unique and complete, and a default can be read. */
static void rows_are_sound(void **state) {
  (void)state;
  const case_keys keys = study_key_table();
  for (int i = 0; i < keys.n; i++) {
    const case_key *key = &keys.key[i];
    assert_ptr_equal(case_key_find(keys, key->path), key);
    assert_true(key->help && key->help[0]);
    assert_true(key->least <= key->most);
  }
  int whole[3] = {0};
  study_table_default("optimise.evaluations", &whole[0]);
  study_table_default("optimise.starts", &whole[1]);
  study_table_default("plan.seed", &whole[2]);
  assert_true(whole[0] == 200 && whole[1] == 4 && whole[2] == 1);
}

/* The words of the table are those of the program. */
static void words_are_known(void **state) {
  (void)state;
  const case_keys keys     = study_key_table();
  char            all[128] = "", path[CASE_PATH];
  for (int i = 0; i < STUDY_N_ALGORITHMS; i++)
    case_append(all, sizeof all, "%s%s", i ? " " : "", study_algorithm_name((study_algorithm)i));
  assert_string_equal(case_key_find(keys, "optimise.algorithm")->words, all);
  for (int i = 0; i < PLAN_N_DISTRIBUTIONS; i++) {
    case_path(path, "uncertain{}.%s", plan_distribution_name((plan_kind)i));
    assert_non_null(case_key_find(keys, path));
  }
}

static void the_manual_lists_every_key(void **state) {
  (void)state;
  char  *text = NULL;
  size_t size = 0;
  FILE  *out  = open_memstream(&text, &size);
  study_print_keys(out);
  fclose(out);
  const case_keys keys = study_key_table();
  for (int i = 0; i < keys.n; i++) {
    char line[96];
    snprintf(line, sizeof line, "\n%s ", keys.key[i].path);
    assert_has(text, line);
    assert_has(text, keys.key[i].help);
  }
  assert_has(text, "\nsamples                         integer        -      8 to 100000 ");
  free(text);
}

/* Read the study with overrides; messages are malloc'ed. */
static shb_status read_with(const char *text, int n, const char *const *set, const char *into,
                            char **messages, study_spec *s) {
  const case_overrides overrides = {.n = n, .text = set, .into = into};
  char                 all[1024], path[SCRATCH_PATH + 16];
  size_t               size = 0;
  snprintf(all, sizeof all, "case: case.yaml\n%s", text);
  scratch_write(study_folder, "study.yaml", all, strlen(all));
  snprintf(path, sizeof path, "%s/study.yaml", study_folder);
  FILE            *errors = open_memstream(messages, &size);
  const shb_status status = study_spec_read_with(path, &overrides, true, errors, s);
  fclose(errors);
  return status;
}

static const char text[] =
    "vary: {contact.mu: [0.3], contact.n0: {from: 5 N, to: 9 N, points: 2}}\n";

/* A key of the study, a varied key with its dots, one more, and a member of a range. */
static void keys_are_set_and_results_moved(void **state) {
  (void)state;
  static const char *const set[] = {"name=other", "vary.contact.mu=[0.2, 0.4]",
                                    "vary.contact.n0.points=3", "vary.mhb.scale=[1, 2]"};
  char                    *messages, digest[DIGEST_TEXT], why[256];
  study_spec               s, child;
  const shb_status         status = read_with(text, 4, set, "elsewhere", &messages, &s);
  if (status != SHB_OK) fail_msg("%s%s", messages, shb_message());
  assert_string_equal(s.name, "other");
  assert_string_equal(s.folder, "elsewhere");
  assert_int_equal(s.keys.n, 3);
  assert_int_equal(s.n_designs, 2 * 3 * 2);
  assert_near(s.keys.key[0].value[1], 0.4, 1e-15);
  assert_has(s.text, "\n# --set vary.contact.n0.points=3\n");
  /* a process that computes designs gets the same study */
  char whole[256];
  snprintf(whole, sizeof whole, "case: case.yaml\n%s", text);
  const study_texts sent = {whole, s.base.text, "", s.inputs, s.sets, s.into};
  assert_ok(study_spec_read_texts(s.path, &sent, stderr, &child));
  assert_int_equal(child.n_designs, s.n_designs);
  assert_string_equal(child.folder, "elsewhere");
  assert_true(study_spec_digest(&child, child.design, digest, why, sizeof why));
  assert_string_equal(digest, s.digest[0]);
  study_spec_free(&child);
  study_spec_free(&s);
  free(messages);
}

static void faults_point_at_the_override(void **state) {
  (void)state;
  static const char *const rows[][2] = {
      {"sampels=9", "--set sampels=9: error: sampels: unknown key; did you mean 'samples'?"},
      {"samples=3", "--set samples=3: error: samples: is 3, must be 8 to 100000"},
      {"vary.contact.nu=[0.2]", "contact.nu: is no key of a case"},
      {"optimise.starts=0", "optimise.starts: is 0, must be 1 to 64"},
      {"vary.contact.n0.scale=logg",
       "contact.n0.scale: 'logg' is not known; expected one of linear"},
      {"plan.sobl=9", "sobl: unknown key; did you mean 'sobol'?"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char      *messages;
    study_spec s;
    assert_int_equal(read_with(text, 1, &rows[i][0], NULL, &messages, &s), SHB_ERR_INPUT);
    assert_has(messages, rows[i][1]);
    study_spec_free(&s);
    free(messages);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rows_are_sound),
      cmocka_unit_test(words_are_known),
      cmocka_unit_test(the_manual_lists_every_key),
      cmocka_unit_test(keys_are_set_and_results_moved),
      cmocka_unit_test(faults_point_at_the_override),
  };
  return cmocka_run_group_tests(tests, study_folder_make, study_folder_remove);
}
