/* The nearest solved design: distances over the ranges, by logarithms of positive keys. */
#include "cases/study/nearest_design.h"

#include "tests/support/check.h"

/* Designs of one or two keys, all done. */
static design_study make(int n_keys, int n, const double *key) {
  design_study s;
  assert_ok(design_study_create(n_keys, 1, 0, &s));
  for (int i = 0; i < n; i++) {
    study_design *d = design_study_add(&s, key + i * n_keys);
    assert_non_null(d);
    d->state      = STUDY_DONE;
    d->tried_from = -1;
  }
  return s;
}

/* 10 lies between 1 and 100 by logarithms: 8 is nearer to 10 than 14 is not, by ratio. */
static void positive_keys_count_by_their_logarithm(void **state) {
  (void)state;
  const double key[] = {1, 10, 6, 16, 100}; /* 10/6 > 16/10, 10 - 6 < 16 - 10 */
  design_study s     = make(1, 5, key);
  assert_int_equal(nearest_design(&s, 1), 3);
  design_study_free(&s);
  const double shifted[] = {-1, 10, 6, 16, 100}; /* not all are positive: by differences */
  s                      = make(1, 5, shifted);
  assert_int_equal(nearest_design(&s, 1), 2);
  design_study_free(&s);
}

/* Each key counts by its range over all designs. */
static void keys_are_divided_by_their_ranges(void **state) {
  (void)state;
  const double key[] = {0, 0, 100, 0, 30, 0, 0, 0.5, 0, -1}; /* ranges 100 and 1.5 */
  design_study s     = make(2, 5, key);
  assert_int_equal(nearest_design(&s, 0), 2); /* 0.3 against 0.33 */
  s.design[1].key[0] = 60;                    /* 0.5 against 0.33 */
  assert_int_equal(nearest_design(&s, 0), 3);
  design_study_free(&s);
}

/* Designs that failed, wait, or were tried again themselves do not count; of equal ones the first
 * does. A key that is the same everywhere has no part. */
static void only_solved_designs_count(void **state) {
  (void)state;
  const double key[] = {5, 1, 5, 2, 5, 3, 5, 3};
  design_study s     = make(2, 4, key);
  assert_int_equal(nearest_design(&s, 0), 1);
  s.design[1].state = STUDY_FAILED;
  assert_int_equal(nearest_design(&s, 0), 2);
  s.design[2].tried_from = 1;
  assert_int_equal(nearest_design(&s, 0), 3);
  s.design[3].state = STUDY_WAITING;
  assert_int_equal(nearest_design(&s, 0), -1);
  design_study_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(positive_keys_count_by_their_logarithm),
      cmocka_unit_test(keys_are_divided_by_their_ranges),
      cmocka_unit_test(only_solved_designs_count),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
