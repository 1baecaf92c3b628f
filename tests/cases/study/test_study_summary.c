/* The statistics of a study for a terminal: those of studies in closed form. */
#include "cases/study/study_summary.h"

#include "tests/support/check.h"
#include "tests/support/studies.h"

/* malloc'ed */
static char *summary_of(studies_kind kind, design_study *s) {
  char  *text = NULL;
  size_t size = 0;
  FILE  *out  = open_memstream(&text, &size);
  assert_non_null(out);
  studies_make(kind, s);
  study_summary_statistics(s, out);
  fclose(out);
  return text;
}

static void uncertain_keys_have_mean_and_indices(void **state) {
  (void)state;
  design_study s;
  char        *text = summary_of(STUDIES_UNCERTAIN, &s), wanted[128];
  snprintf(wanted, sizeof wanted, "%d samples, %d failed", s.uncertainty.n_samples,
           s.uncertainty.n_failed);
  assert_has(text, wanted);
  snprintf(wanted, sizeof wanted, "mean %.5g, deviation %.4g", s.uncertainty.mean[0],
           s.uncertainty.deviation[0]);
  assert_has(text, wanted);
  assert_has(text, s.output[0].name);
  for (int k = 0; k < s.n_keys; k++) assert_has(text, s.key[k].name);
  free(text);
  design_study_free(&s);
}

/* Each group has a line; the best one is marked. */
static void groups_are_told_with_the_best(void **state) {
  (void)state;
  design_study s;
  char        *text  = summary_of(STUDIES_ROBUST, &s);
  int          lines = 0, marks = 0;
  for (const char *at = text; (at = strstr(at, s.key[0].name)); at++) lines++;
  for (const char *at = text; (at = strchr(at, '*')); at++) marks++;
  assert_true(lines >= s.robust.n_groups);
  assert_int_equal(marks, 1);
  free(text);
  design_study_free(&s);
}

static void a_study_without_uncertain_keys_has_none(void **state) {
  (void)state;
  static const studies_kind kinds[] = {STUDIES_GRID, STUDIES_EMPTY, STUDIES_FAILED};
  for (int i = 0; i < 3; i++) {
    design_study s;
    char        *text = summary_of(kinds[i], &s);
    assert_string_equal(text, "");
    free(text);
    design_study_free(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(uncertain_keys_have_mean_and_indices),
      cmocka_unit_test(groups_are_told_with_the_best),
      cmocka_unit_test(a_study_without_uncertain_keys_has_none),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
