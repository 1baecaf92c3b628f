/* A first solution without a guess: at any preload and parameter, and what it leaves unchanged. */
#include "mhb/continuation/first_solution.h"

#include "mhb/continuation/balance_curve.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/settings.h"
#include "tests/support/shroud_face.h"
#include "tests/support/three_degree.h"

static double relative_residual(mhb_balance *b, const double *x, double value) {
  double r[b->n];
  mhb_balance_evaluate(b, x, value, r, NULL, NULL);
  return mhb_norm(r, b->n) / mhb_norm(x, b->n);
}

static void assert_solves(mhb_balance *b, const double *x, double value) {
  assert_below(relative_residual(b, x, value), 1e-9);
}

/* From open to stuck, through the resonances. */
static void there_is_one_at_every_preload(void **state) {
  (void)state;
  static const double n0[] = {-1, -0.05, 0, 0.02, 0.1, 5}, omega[] = {0.85, 0.95, 1.1, 1.3, 1.7};
  modal_model         model;
  mhb_settings        s = ground_settings(0.3, 1, 0.5, 0, 3);
  mhb_balance        *b;
  mhb_newton         *newton;
  int                 iterations;
  double              worst = 0;
  three_degree_model(&model);
  assert_ok(mhb_balance_create(&model, &s, &b));
  newton = mhb_newton_create(b->n);
  double x[b->n];
  for (int i = 0; i < 6; i++)
    for (int w = 0; w < 5; w++) {
      mhb_balance_set_preload(b, n0[i]);
      assert_int_equal(mhb_first_solution(newton, b, omega[w], 1e-11, x, &iterations),
                       MHB_CONVERGED);
      assert_true(b->eval->at.n0 == n0[i]);
      worst = fmax(worst, relative_residual(b, x, omega[w]));
    }
  print_message("largest residual %.1e\n", worst);
  assert_below(worst, 1e-10);
  mhb_newton_destroy(newton);
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

/* The parameter stands, and the value is its own. */
static void the_parameter_stands(void **state) {
  (void)state;
  static const struct {
    mhb_parameter parameter;
    double        value;
  } row[] = {{MHB_IN_FREQUENCY, 1.1}, {MHB_IN_N0, 0.2}, {MHB_IN_SCALE, 0.7},
             {MHB_IN_MU, 0.4},        {MHB_IN_KU, 0.9}, {MHB_IN_KV, 0.6}};
  modal_model model;
  random_model(2, WITH_LEFT | WITH_RESIDUAL, 3, &model);
  for (int i = 0; i < 6; i++) {
    mhb_settings s = random_settings(2);
    mhb_balance *b;
    mhb_newton  *newton;
    int          iterations;
    assert_ok(mhb_balance_create(&model, &s, &b));
    newton = mhb_newton_create(b->n);
    double x[b->n];
    mhb_balance_set_value(b, 1.3);
    mhb_balance_set_parameter(b, row[i].parameter);
    assert_int_equal(mhb_first_solution(newton, b, row[i].value, 1e-11, x, &iterations),
                     MHB_CONVERGED);
    assert_int_equal(b->parameter, row[i].parameter);
    assert_near(mhb_parameter_get(&b->eval->at, row[i].parameter), row[i].value, 1e-15);
    assert_true(b->eval->at.omega == (i == 0 ? 1.1 : 1.3));
    assert_below(relative_residual(b, x, row[i].value), 1e-10);
    mhb_newton_destroy(newton);
    mhb_balance_destroy(b);
  }
  modal_model_free(&model);
}

/* A tolerance that nothing meets: every way is tried, and the failure is told with the balance as
 * it was. */
static void a_failure_leaves_the_balance_as_it_was(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = ground_settings(0.3, 1, 1, 0.05, 1);
  mhb_balance *b;
  mhb_newton  *newton;
  int          iterations;
  one_degree_model(0.02, 1, 0.1, &model);
  assert_ok(mhb_balance_create(&model, &s, &b));
  newton = mhb_newton_create(b->n);
  double x[b->n];
  mhb_balance_set_preload(b, 0.05);
  mhb_balance_set_value(b, 1.2);
  mhb_balance_set_parameter(b, MHB_IN_MU);
  mhb_reason reason = mhb_first_solution(newton, b, 0.3, -1, x, &iterations);
  print_message("reason %d\n", (int)reason);
  assert_true(reason < 0);
  assert_int_equal(b->parameter, MHB_IN_MU);
  assert_true(b->eval->at.n0 == 0.05 && b->eval->at.mu == 0.3);
  mhb_newton_destroy(newton);
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

typedef struct {
  int                calls, last; /* last: the call that gives up, 0: none */
  const mhb_balance *balance;     /* NULL: the next two are not read */
  long               seen, gap; /* linearisations at the last call; the most from one to the next */
} counter;

static bool count(void *context) {
  counter *c = context;
  if (c->balance) {
    const long since = c->balance->n_linearised - c->seen;
    c->gap           = since > c->gap ? since : c->gap;
    c->seen          = c->balance->n_linearised;
  }
  return ++c->calls < c->last || c->last == 0;
}

/* Friction 400 to 40,000 times as stiff as the blade. From the limits Newton's method fails at some
 * frequencies, and fewer harmonics or a softer contact lead on. A search takes no more than its
 * share of work, and is told of all along. */
static void nearly_rigid_friction_has_one(void **state) {
  (void)state;
  static const double ku[] = {400, 4000, 40000};
  enum { FREQUENCIES = 6, MOST = 700 };
  modal_model model;
  long        dearest = 0;
  one_degree_model(0.01, 1, 0.05, &model);
  for (int i = 0; i < 3; i++) {
    mhb_settings s = ground_settings(0.3, 1, ku[i], 0.1, 31);
    mhb_balance *b;
    mhb_newton  *newton;
    assert_ok(mhb_balance_create(&model, &s, &b));
    newton = mhb_newton_create(b->n);
    double x[b->n];
    for (int w = 0; w < FREQUENCIES; w++) {
      counter    told   = {0};
      mhb_watch  watch  = {.go_on = count, .context = &told, .share = 1};
      const long before = b->n_linearised;
      int        iterations;
      double     omega = 0.5 + 0.26 * w;
      mhb_reason reason =
          mhb_first_solution_watched(newton, b, omega, 1e-10, &watch, x, &iterations);
      dearest = b->n_linearised - before > dearest ? b->n_linearised - before : dearest;
      assert_true(told.calls > 0);
      assert_int_equal(reason, MHB_CONVERGED);
      assert_solves(b, x, omega);
    }
    mhb_newton_destroy(newton);
    mhb_balance_destroy(b);
  }
  print_message("the dearest search took %ld linearisations\n", dearest);
  assert_below((double)dearest, MOST);
  modal_model_free(&model);
}

/* The third Newton method is not begun. */
static void a_watch_stops_it(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = ground_settings(0.3, 1, 1, 0.05, 5);
  mhb_balance *b;
  mhb_newton  *newton;
  counter      told  = {.last = 3};
  mhb_watch    watch = {.go_on = count, .context = &told, .share = 1};
  int          iterations;
  one_degree_model(0.02, 1, 0.1, &model);
  assert_ok(mhb_balance_create(&model, &s, &b));
  newton = mhb_newton_create(b->n);
  double x[b->n];
  assert_int_equal(mhb_first_solution_watched(newton, b, 1.2, -1, &watch, x, &iterations),
                   MHB_GIVEN_UP);
  assert_in_range(told.calls, 3, 8);
  mhb_newton_destroy(newton);
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

/* The first call comes before any linearisation. Then there is one in every step of Newton's
 * method, whose line search takes eight, and in every step of a curve. There up to twelve
 * corrections are made for each length that is tried. */
static void a_search_is_told_of_all_along(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = ground_settings(0.3, 1, 4000, 0.1, 21);
  mhb_balance *b;
  mhb_newton  *newton;
  int          iterations;
  one_degree_model(0.01, 1, 0.05, &model);
  assert_ok(mhb_balance_create(&model, &s, &b));
  newton = mhb_newton_create(b->n);
  double    x[b->n];
  counter   told    = {.balance = b, .seen = b->n_linearised};
  mhb_watch watch   = {.go_on = count, .context = &told, .share = 0.5};
  counter   never   = {.last = 1, .balance = b, .seen = b->n_linearised};
  mhb_watch stopped = {.go_on = count, .context = &never, .share = 1};
  assert_int_equal(mhb_first_solution_watched(newton, b, 1.28, 1e-10, &stopped, x, &iterations),
                   MHB_GIVEN_UP);
  assert_int_equal(b->n_linearised, 0); /* told before the first, and nothing was done */
  mhb_first_solution_watched(newton, b, 1.28, -1, &watch, x, &iterations);
  print_message("%d calls, at most %ld of %ld linearisations between two\n", told.calls, told.gap,
                b->n_linearised);
  assert_true(told.calls > 10 && b->n_linearised > 100);
  assert_in_range(told.gap, 1, 100);
  mhb_newton_destroy(newton);
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

/* Rigid friction that slips over half of the period, with 33 to 63 harmonics. From the limits and
 * from zero Newton's method fails; solutions of fewer harmonics lead on soon. */
static void many_harmonics_have_one_from_fewer(void **state) {
  (void)state;
  static const int    harmonics[] = {33, 41, 63};
  static const double omegas[]    = {0.62, 0.94, 1.04, 1.45};
  enum { FREQUENCIES = 4 };
  modal_model model;
  long        dearest = 0;
  one_degree_model(0.01, 1, 0.05, &model);
  for (int i = 0; i < 3; i++) {
    mhb_settings s = ground_settings(0.3, 0, 40000, 0.15, harmonics[i]);
    mhb_balance *b;
    mhb_newton  *newton;
    assert_ok(mhb_balance_create(&model, &s, &b));
    newton = mhb_newton_create(b->n);
    double x[b->n];
    for (int w = 0; w < FREQUENCIES; w++) {
      const long   before = b->n_linearised;
      const double omega  = omegas[w];
      int          iterations;
      assert_int_equal(mhb_first_solution(newton, b, omega, 1e-10, x, &iterations), MHB_CONVERGED);
      assert_solves(b, x, omega);
      dearest = b->n_linearised - before > dearest ? b->n_linearised - before : dearest;
    }
    mhb_newton_destroy(newton);
    mhb_balance_destroy(b);
  }
  print_message("the dearest took %ld linearisations\n", dearest);
  assert_true(dearest > 150); /* Newton's method alone does not do */
  assert_below((double)dearest, 1000);
  modal_model_free(&model);
}

/* Curves that were started; the linker leads the calls here. */
static int n_started;
mhb_reason __real_mhb_arclength_start(mhb_arclength *curve, const double *x, double value,
                                      int direction);
mhb_reason __wrap_mhb_arclength_start(mhb_arclength *curve, const double *x, double value,
                                      int direction);
mhb_reason __wrap_mhb_arclength_start(mhb_arclength *curve, const double *x, double value,
                                      int direction) {
  n_started++;
  return __real_mhb_arclength_start(curve, x, value, direction);
}

/* With stiff contact each pair adds kinks to the curve in the preload. 20 pairs have more than 200
 * steps, all of which are taken: the first curve arrives. */
static void the_curve_passes_the_kinks_of_many_pairs(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = shroud_face_settings(3);
  mhb_balance *b;
  mhb_newton  *newton;
  const double omega = 2 * 3.14159265358979 * 225;
  int          iterations;
  s.kv *= 1000;
  for (int i = 0; i < 3; i++) s.ku[i] *= 1000;
  s.n0[0] = 20;
  shroud_face_model(20, 150, &model);
  assert_ok(mhb_balance_create(&model, &s, &b));
  newton = mhb_newton_create(b->n);
  double x[b->n];
  mhb_balance_set_preload(b, s.n0[0]);
  n_started = 0;
  assert_int_equal(mhb_first_solution(newton, b, omega, 1e-10, x, &iterations), MHB_CONVERGED);
  print_message("%d curves, %ld linearisations\n", n_started, b->n_linearised);
  assert_in_range(n_started, 1, 3);
  assert_below(relative_residual(b, x, omega), 2e-10);
  mhb_newton_destroy(newton);
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(there_is_one_at_every_preload),
                                     cmocka_unit_test(the_curve_passes_the_kinks_of_many_pairs),
                                     cmocka_unit_test(the_parameter_stands),
                                     cmocka_unit_test(nearly_rigid_friction_has_one),
                                     cmocka_unit_test(many_harmonics_have_one_from_fewer),
                                     cmocka_unit_test(a_search_is_told_of_all_along),
                                     cmocka_unit_test(a_watch_stops_it),
                                     cmocka_unit_test(a_failure_leaves_the_balance_as_it_was)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
