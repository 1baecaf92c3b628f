/* The result of a design as bytes: there and back, cut, damaged, copied. */
#include "cases/study/design_message.h"

#include "tests/support/check.h"

enum { OUTPUTS = 3, DERIVATIVES = 2, POINTS = 4 };

/* A study of two designs; the first has everything. */
static design_study make(void) {
  design_study s;
  const double key[1] = {1};
  assert_ok(design_study_create(1, OUTPUTS, DERIVATIVES, &s));
  for (int i = 0; i < 2; i++) assert_non_null(design_study_add(&s, key));
  study_design *d = &s.design[0];
  d->state        = STUDY_NOT_CONVERGED;
  d->seconds      = 2.385;
  for (int i = 0; i < OUTPUTS; i++) d->value[i] = i == 1 ? NAN : 1.5 * i, d->error[i] = 1e-3 * i;
  for (int i = 0; i < DERIVATIVES; i++) d->derivative[i] = -7.25 + i;
  study_design_set_reason(d, "the curve ended at 131 Hz");
  assert_ok(study_curve_take(&d->curve, POINTS));
  for (int i = 0; i < POINTS; i++) {
    d->curve.frequency[i] = 100 + i;
    d->curve.amplitude[i] = 1e-5 * i;
    d->curve.branch[i]    = i / 2;
    d->curve.stable[i]    = i - 1;
  }
  return s;
}

static void check_equal(const study_design *a, const study_design *b) {
  assert_int_equal(a->state, b->state);
  assert_string_equal(a->reason, b->reason);
  assert_memory_equal(a->value, b->value, OUTPUTS * sizeof(double));
  assert_memory_equal(a->error, b->error, OUTPUTS * sizeof(double));
  assert_memory_equal(a->derivative, b->derivative, DERIVATIVES * sizeof(double));
  assert_int_equal(a->curve.n, b->curve.n);
  assert_memory_equal(a->curve.frequency, b->curve.frequency, POINTS * sizeof(double));
  assert_memory_equal(a->curve.amplitude, b->curve.amplitude, POINTS * sizeof(double));
  assert_memory_equal(a->curve.branch, b->curve.branch, POINTS * sizeof(int));
  assert_memory_equal(a->curve.stable, b->curve.stable, POINTS * sizeof(int));
}

static void a_design_comes_back_as_it_was(void **state) {
  (void)state;
  design_study s = make();
  char        *bytes;
  size_t       size;
  assert_ok(design_message_pack(&s.design[0], OUTPUTS, DERIVATIVES, &bytes, &size));
  assert_ok(design_message_unpack(bytes, size, OUTPUTS, DERIVATIVES, &s.design[1]));
  check_equal(&s.design[1], &s.design[0]);
  assert_near(s.design[1].seconds, 2.385, 0);
  free(bytes);
  design_study_free(&s);
}

/* A message without a curve and a reason takes those of the design away. */
static void an_empty_result_replaces_a_full_one(void **state) {
  (void)state;
  design_study s = make();
  char        *bytes;
  size_t       size;
  s.design[1].state = STUDY_FAILED;
  assert_ok(design_message_pack(&s.design[1], OUTPUTS, DERIVATIVES, &bytes, &size));
  assert_ok(design_message_unpack(bytes, size, OUTPUTS, DERIVATIVES, &s.design[0]));
  assert_int_equal(s.design[0].state, STUDY_FAILED);
  assert_null(s.design[0].reason);
  assert_int_equal(s.design[0].curve.n, 0);
  free(bytes);
  design_study_free(&s);
}

static void a_copy_cost_nothing(void **state) {
  (void)state;
  design_study s = make();
  assert_ok(design_message_copy(&s.design[0], OUTPUTS, DERIVATIVES, &s.design[1]));
  check_equal(&s.design[1], &s.design[0]);
  assert_near(s.design[1].seconds, 0, 0);
  design_study_free(&s);
}

/* Whatever length is left of it, and with other numbers of outputs, it is refused. */
static void a_cut_or_foreign_message_is_refused(void **state) {
  (void)state;
  design_study s = make();
  char        *bytes;
  size_t       size;
  assert_ok(design_message_pack(&s.design[0], OUTPUTS, DERIVATIVES, &bytes, &size));
  for (size_t left = 0; left < size; left++)
    assert_refused(design_message_unpack(bytes, left, OUTPUTS, DERIVATIVES, &s.design[1]),
                   SHB_ERR_IO, "the message of a design is");
  for (int i = 0; i < 2; i++)
    assert_refused(design_message_unpack(bytes, size, OUTPUTS + i, DERIVATIVES + !i, &s.design[1]),
                   SHB_ERR_IO, "damaged");
  bytes[0] = 99; /* no state */
  assert_refused(design_message_unpack(bytes, size, OUTPUTS, DERIVATIVES, &s.design[1]), SHB_ERR_IO,
                 "damaged");
  assert_int_equal(s.design[1].state, STUDY_WAITING);
  free(bytes);
  design_study_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_design_comes_back_as_it_was),
      cmocka_unit_test(an_empty_result_replaces_a_full_one),
      cmocka_unit_test(a_copy_cost_nothing),
      cmocka_unit_test(a_cut_or_foreign_message_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
