/* Curves and their points: what they own. */
#include "mhb/continuation/curve.h"

#include "mesh/base/memory.h"
#include "tests/support/check.h"
#include "tests/support/scalar_curve.h"

static int n_destroyed, n_evaluations;

static void count_destroyed(mhb_curve_system *system) {
  (void)system;
  n_destroyed++;
}

static mhb_evaluation *make_evaluation(mhb_curve_system *system) {
  (void)system;
  n_evaluations++;
  return shb_alloc_zeroed(1, sizeof(mhb_evaluation));
}

static void free_evaluation(mhb_curve_system *system, mhb_evaluation *evaluation) {
  (void)system;
  n_evaluations--;
  free(evaluation);
}

static mhb_curve_system counting_system(void) {
  n_destroyed = n_evaluations = 0;
  return (mhb_curve_system){.n                  = 3,
                            .row_length         = 3,
                            .copies             = 1,
                            .destroy            = count_destroyed,
                            .evaluation_create  = make_evaluation,
                            .evaluation_destroy = free_evaluation};
}

static void a_curve_owns_its_system_and_points(void **state) {
  (void)state;
  mhb_arclength   *curve;
  mhb_curve_system system = counting_system();
  curve                   = mhb_arclength_create(&system, 2, 5);
  assert_int_equal(curve->n, 3);
  assert_true(curve->low == 2 && curve->high == 5 && curve->parameter_scale == 3);
  assert_int_equal(n_evaluations, 6); /* current, next, trial, three of the bracket */
  assert_int_equal(n_destroyed, 0);
  mhb_arclength_destroy(curve);
  assert_int_equal(n_evaluations, 0);
  assert_int_equal(n_destroyed, 1);
  mhb_arclength_destroy(NULL);
}

static void a_point_without_evaluation_is_possible(void **state) {
  (void)state;
  mhb_curve_point  point;
  mhb_curve_system system   = counting_system();
  system.evaluation_create  = NULL;
  system.evaluation_destroy = NULL;
  mhb_curve_point_create(&system, &point);
  assert_null(point.evaluation);
  point.tangent[3] = 1; /* one longer than x */
  mhb_curve_point_destroy(&system, &point);
  assert_null(point.x);
  mhb_curve_point_destroy(&system, &point); /* a zeroed one */
}

static void advance_exchanges_the_ends_of_the_step(void **state) {
  (void)state;
  mhb_arclength *curve = scalar_curve(scalar_line, 0, 1);
  scalar_step(curve, 2.1, 0.1, 2.3, 0.3);
  const double *x = curve->next.x;
  mhb_arclength_advance(curve);
  assert_ptr_equal(curve->current.x, x);
  assert_true(curve->current.value == 0.3 && curve->next.value == 0.1);
  mhb_arclength_destroy(curve);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_curve_owns_its_system_and_points),
                                     cmocka_unit_test(a_point_without_evaluation_is_possible),
                                     cmocka_unit_test(advance_exchanges_the_ends_of_the_step)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
