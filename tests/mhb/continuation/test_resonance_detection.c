/* Steps over a lightly coupled mode: which of its resonances count as skipped. */
#include "mhb/continuation/resonance_detection.h"

#include "mesh/base/constants.h"
#include "mhb/continuation/balance_curve.h"
#include "mhb/continuation/corrector.h"
#include "tests/support/check.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

static const double SECOND = 1.7, ZETA = 1e-3; /* the second mode, rad/s */

typedef struct {
  modal_model    model;
  mhb_settings   settings;
  mhb_balance   *balance;
  mhb_arclength *curve;
  mhb_resonances resonances; /* that of the second mode alone */
  mhb_resonance  second;
} fixture;

/* A step between two frequencies, rad/s; the second mode moves contact and probe, driven by force.
 */
static void set_up(fixture *f, double contact, double probe, double force, double from, double to) {
  two_mode_model(SECOND, ZETA, contact, probe, force, &f->model);
  f->settings   = ground_settings(0.3, 1, 1, 0.05, 3);
  f->second     = (mhb_resonance){.value = SECOND, .half_width = ZETA * SECOND, .k = 1, .mode = 1};
  f->resonances = (mhb_resonances){.at = &f->second, .n = 1, .capacity = 1};
  assert_ok(mhb_balance_create(&f->model, &f->settings, &f->balance));
  mhb_balance_set_preload(f->balance, 0.05);
  f->curve = mhb_balance_curve_create(f->balance, 0.3, 3);
  double x[f->curve->n];
  assert_true(f->curve->system->start_of_newton(f->curve->system, to, 1, x));
  assert_int_equal(mhb_arclength_start(f->curve, x, to, 1), MHB_CONVERGED);
  mhb_arclength_advance(f->curve);
  assert_true(f->curve->system->start_of_newton(f->curve->system, from, 1, x));
  assert_int_equal(mhb_arclength_start(f->curve, x, from, to > from ? 1 : -1), MHB_CONVERGED);
  mhb_arclength_measure(f->curve, &f->curve->next);
}

static void tear_down(fixture *f) {
  mhb_arclength_destroy(f->curve);
  mhb_balance_destroy(f->balance);
  modal_model_free(&f->model);
}

static bool is_skipped(fixture *f) {
  return mhb_resonance_skipped(f->curve, f->balance, &f->resonances);
}

/* In both directions, seen by the contact or by the probe alone, and once only. */
static void a_step_over_a_resonance_is_seen(void **state) {
  (void)state;
  static const struct {
    double contact, probe, force, from, to;
    bool   wanted;
  } row[] = {{0.01, 0, 0.2, 1.65, 1.75, true},     {0.01, 0, 0.2, 1.75, 1.65, true},
             {0, 0.01, 0.2, 1.65, 1.75, true},     {0, 0.01, 0.2, 1.75, 1.65, true},
             {0, 0, 0.2, 1.65, 1.75, false},         /* moves neither */
             {0, 0.01, 0, 1.65, 1.75, false},        /* nothing drives it */
             {0, 1e-6, 1e-3, 1.65, 1.75, false},     /* too little */
             {0.01, 1, 0.2, 1.6, 1.65, false},       /* not on the step */
             {0.01, 1, 0.2, 1.6995, 1.7005, false}}; /* the step resolves it */
  for (int i = 0; i < 9; i++) {
    fixture f;
    set_up(&f, row[i].contact, row[i].probe, row[i].force, row[i].from, row[i].to);
    bool skipped = is_skipped(&f);
    print_message("row %d: %s\n", i, skipped ? "skipped" : "nothing skipped");
    assert_true(skipped == row[i].wanted);
    assert_true(f.second.significant == row[i].wanted);
    assert_false(is_skipped(&f)); /* the steps know of it now */
    tear_down(&f);
  }
}

/* A place that is no mode, as between free and stuck, is looked at by its solution alone. */
static void a_place_without_resonance_is_not_significant(void **state) {
  (void)state;
  fixture f;
  set_up(&f, 0.01, 1, 0.2, 1.9, 2);
  f.second = (mhb_resonance){.value = 1.95, .half_width = 0.002, .k = 1, .mode = -1};
  assert_false(is_skipped(&f));
  assert_false(f.second.significant);
  tear_down(&f);
}

/* Where no solution is found at the place, the step may have skipped one. */
static int never_factor(mhb_curve_system *system, const mhb_curve_point *point,
                        const double *column, const double *row) {
  (void)system;
  (void)point;
  (void)column;
  (void)row;
  return 0;
}

static void a_place_that_is_not_solved_counts(void **state) {
  (void)state;
  fixture f;
  set_up(&f, 0.01, 1, 0.2, 1.9, 2);
  f.second                = (mhb_resonance){.value = 1.95, .half_width = 0.002, .k = 1, .mode = -1};
  f.curve->system->factor = never_factor;
  assert_true(is_skipped(&f));
  tear_down(&f);
}

/* The resonances of the balance contain the mode, and the step limit heeds it once it is known. */
static void the_step_limit_follows(void **state) {
  (void)state;
  fixture f;
  set_up(&f, 0.01, 1, 0.2, 1.65, 1.75);
  mhb_curve_system *s = f.curve->system;
  assert_true(isinf(s->resonance_step_limit(s, 1.65, 1)));
  assert_true(s->resonance_skipped(f.curve));
  double most = s->resonance_step_limit(s, 1.65, 1);
  print_message("step limit %.4f rad/s\n", most);
  assert_true(most > 0 && most < 0.06);
  assert_true(isinf(s->resonance_step_limit(s, 1.65, -1)));
  tear_down(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_step_over_a_resonance_is_seen),
                                     cmocka_unit_test(a_place_without_resonance_is_not_significant),
                                     cmocka_unit_test(a_place_that_is_not_solved_counts),
                                     cmocka_unit_test(the_step_limit_follows)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
