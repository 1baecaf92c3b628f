/* The error of the largest multiplier by the harmonics left out, against solutions of 31 harmonics,
 * and the verdict that it gives. */
#include <math.h>

#include "mhb/balance/truncation_error.h"
#include "mhb/branches/branch_stability.h"
#include "tests/support/check.h"
#include "tests/support/periodic.h"
#include "tests/support/three_degree.h"

enum { FINE = 31, LEVELS = 4, PLACES = 6 };
static const int HARMONICS[LEVELS] = {3, 5, 9, 15};

/* Largest multiplier at a frequency with m harmonics, judged with its error. */
static mhb_multipliers judge(const modal_model *model, double omega, int m) {
  periodic        p;
  mhb_floquet    *floquet;
  mhb_truncation *truncation;
  mhb_multipliers out;
  mhb_settings    s = ground_settings(0.4, 0.8, 0.5, 0.1, m);
  periodic_create(model, &s, omega, NULL, &p);
  assert_ok(mhb_truncation_create(p.residual, &truncation));
  assert_ok(mhb_branch_floquet_create(p.residual, &floquet));
  const mhb_judged_point at = {p.x, omega, INFINITY};
  mhb_branch_floquet_judge(floquet, p.residual, truncation, &at, &out);
  out.multiplier = NULL;
  mhb_floquet_destroy(floquet);
  mhb_truncation_destroy(truncation);
  periodic_destroy(&p);
  return out;
}

/* The estimate is not below the error; the sub-steps add what they change. It falls as the error
 * does. No verdict is opposite to that of 31 harmonics. */
static void the_error_is_told_and_falls_with_the_harmonics(void **state) {
  (void)state;
  modal_model model;
  double      most[LEVELS] = {0}, told[LEVELS] = {0}, worst = 0;
  int         undecided[LEVELS] = {0};
  three_degree_model(&model);
  for (int place = 0; place < PLACES; place++) {
    const double          omega = 1.16 + 0.018 * place; /* stable, then modulated from 1.2006 on */
    const mhb_multipliers fine  = judge(&model, omega, FINE);
    for (int i = 0; i < LEVELS; i++) {
      const mhb_multipliers m     = judge(&model, omega, HARMONICS[i]);
      const double          error = fabs(m.largest - fine.largest);
      most[i]                     = fmax(most[i], error);
      told[i]                     = fmax(told[i], m.error);
      undecided[i] += m.verdict == MHB_UNDECIDED;
      worst = fmax(worst, error / (m.error + 1e-4));
      assert_true(m.verdict == MHB_UNDECIDED ||
                  (m.verdict == MHB_UNSTABLE) == (fine.verdict == MHB_UNSTABLE));
    }
  }
  for (int i = 0; i < LEVELS; i++)
    print_message("%2d harmonics: true error to %.1e, told to %.1e, undecided %d of %d\n",
                  HARMONICS[i], most[i], told[i], undecided[i], PLACES);
  print_message("true error over told: %.2f at most\n", worst);
  assert_true(worst < 1);
  assert_true(most[LEVELS - 1] < 0.2 * most[0] && told[LEVELS - 1] < 0.2 * told[0]);
  modal_model_free(&model);
}

/* On both sides of the border, and on it as far as the error goes. */
static void within_the_error_nothing_is_judged(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  for (int i = 0; i < 2; i++) {
    mhb_multipliers   m        = judge(&model, i ? 1.23 : 1.18, 5);
    const mhb_verdict verdict  = i ? MHB_UNSTABLE : MHB_STABLE;
    const double      distance = mhb_floquet_distance(&m);
    print_message("|mu| %.4f: %.4f from the border, error %.1e\n", m.largest, distance, m.error);
    assert_int_equal(m.verdict, verdict);
    mhb_floquet_set_error(0.99 * distance, &m);
    assert_int_equal(m.verdict, verdict);
    mhb_floquet_set_error(1.01 * distance, &m);
    assert_int_equal(m.verdict, MHB_UNDECIDED);
  }
  modal_model_free(&model);
}

/* A contact that sticks or is open throughout leaves no harmonics out. */
static void a_linear_motion_has_no_error(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  const mhb_multipliers m = judge(&model, 0.3, 5);
  assert_true(m.error == 0 && m.verdict == MHB_STABLE);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_error_is_told_and_falls_with_the_harmonics),
      cmocka_unit_test(within_the_error_nothing_is_judged),
      cmocka_unit_test(a_linear_motion_has_no_error)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
