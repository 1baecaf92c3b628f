/* The balance as a system of continuation: derivatives, bordered systems, regime, options. */
#include "mhb/continuation/balance_curve.h"

#include <lapacke.h>

#include "mhb/continuation/corrector.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

enum { PAIRS = 2, H = 2, N = PAIRS * 3 * (2 * H + 1) };

typedef struct {
  modal_model    model;
  mhb_settings   settings;
  mhb_balance   *balance;
  mhb_arclength *curve;
} fixture;

static void set_up(fixture *f, mhb_parameter parameter, double n0, double low, double high) {
  random_model(PAIRS, WITH_LEFT | WITH_RESIDUAL, 4, &f->model);
  f->model.n_load       = 1; /* harmonic 2 is not driven */
  f->settings           = random_settings(H);
  f->settings.n0[0]     = n0;
  f->settings.tolerance = 1e-10;
  assert_ok(mhb_balance_create(&f->model, &f->settings, &f->balance));
  mhb_balance_set_preload(f->balance, n0);
  mhb_balance_set_value(f->balance, 1.2); /* rad/s */
  mhb_balance_set_parameter(f->balance, parameter);
  f->curve = mhb_balance_curve_create(f->balance, low, high);
  assert_int_equal(f->curve->n, N);
}

static void tear_down(fixture *f) {
  mhb_arclength_destroy(f->curve);
  mhb_balance_destroy(f->balance);
  modal_model_free(&f->model);
}

static void set_random(mhb_curve_point *point, double size, double value, unsigned long long seed) {
  for (int i = 0; i < N; i++) point->x[i] = size * random_unit(&seed);
  point->value = value;
}

static double norm_of_difference(const double *a, const double *b, int n) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sqrt(sum);
}

/* ---- derivatives ---- */

static const struct {
  mhb_parameter parameter;
  double        value, low, high;
} PARAMETERS[] = {{MHB_IN_FREQUENCY, 1.3, 0.9, 2},
                  {MHB_IN_N0, 0.25, -1, 1},
                  {MHB_IN_SCALE, 0.8, 0, 2},
                  {MHB_IN_MU, 0.5, 0, 1}};

/* The slope is the derivative by the value: central differences approach it with second order. */
static void the_slope_is_the_derivative_by_the_value(void **state) {
  (void)state;
  for (int i = 0; i < 4; i++) {
    fixture f;
    set_up(&f, PARAMETERS[i].parameter, 0.3, PARAMETERS[i].low, PARAMETERS[i].high);
    mhb_curve_system *s = f.curve->system;
    mhb_curve_point  *p = &f.curve->current, *q = &f.curve->next;
    double            error[2];
    set_random(p, 0.3, PARAMETERS[i].value, 7);
    s->linearise(s, p);
    memcpy(q->x, p->x, sizeof(double) * N);
    for (int k = 0; k < 2; k++) {
      double h = k ? 5e-4 : 1e-3, plus[N], difference[N];
      q->value = p->value + h;
      s->evaluate(s, q);
      memcpy(plus, q->r, sizeof plus);
      q->value = p->value - h;
      s->evaluate(s, q);
      for (int j = 0; j < N; j++) difference[j] = (plus[j] - q->r[j]) / (2 * h);
      error[k] = norm_of_difference(difference, p->slope, N) / mhb_norm(p->slope, N);
    }
    print_message("%s: %.1e %.1e\n", mhb_parameter_name(PARAMETERS[i].parameter), error[0],
                  error[1]);
    assert_below(error[1], 1e-4);
    assert_true(error[1] < 0.4 * error[0] || error[0] < 1e-9);
    tear_down(&f);
  }
}

static void evaluate_gives_the_same_residual(void **state) {
  (void)state;
  fixture f;
  set_up(&f, MHB_IN_FREQUENCY, 0.3, 0.9, 2);
  mhb_curve_system *s = f.curve->system;
  mhb_curve_point  *p = &f.curve->current;
  double            r[N], slope[N];
  set_random(p, 0.3, 1.3, 7);
  s->linearise(s, p);
  memcpy(r, p->r, sizeof r);
  memcpy(slope, p->slope, sizeof slope);
  s->evaluate(s, p);
  assert_below(norm_of_difference(r, p->r, N), 1e-14 * mhb_norm(r, N));
  assert_memory_equal(slope, p->slope, sizeof slope); /* derivatives stay */
  tear_down(&f);
}

/* ---- bordered systems ---- */

/* a[N+1][N+1] column-major <- [J column; row] at a point, J dense. */
static void dense_system(fixture *f, const mhb_curve_point *p, const double *column,
                         const double *row, double *a) {
  double jacobian[N * N], r[N];
  mhb_balance_use(f->balance, NULL);
  mhb_balance_evaluate(f->balance, p->x, p->value, r, jacobian, NULL);
  for (int j = 0; j < N; j++) {
    memcpy(a + j * (N + 1), jacobian + j * N, sizeof(double) * N);
    a[j * (N + 1) + N] = row[j];
  }
  memcpy(a + N * (N + 1), column, sizeof(double) * (N + 1));
}

static int sign_of_determinant(double *a) {
  lapack_int pivot[N + 1];
  int        sign = 1;
  assert_int_equal(LAPACKE_dgetrf(LAPACK_COL_MAJOR, N + 1, N + 1, a, N + 1, pivot), 0);
  for (int i = 0; i <= N; i++) {
    if (a[i * (N + 2)] < 0) sign = -sign;
    if (pivot[i] != i + 1) sign = -sign;
  }
  return sign;
}

/* From stuck to slipping and opening: the condensed solution is that of the dense Jacobian. */
static void factors_solve_the_dense_system(void **state) {
  (void)state;
  static const double size[] = {1e-4, 0.05, 0.3, 2};
  for (int i = 0; i < 4; i++) {
    fixture f;
    set_up(&f, MHB_IN_FREQUENCY, 0.3, 0.9, 2);
    mhb_curve_system  *s = f.curve->system;
    mhb_curve_point   *p = &f.curve->current;
    double             a[(N + 1) * (N + 1)], rhs[N + 1], z[N + 1], column[N + 1], row[N + 1];
    unsigned long long seed = 11;
    set_random(p, size[i], 1.3, 5 + (unsigned)i);
    for (int k = 0; k <= N; k++) {
      column[k] = random_unit(&seed);
      row[k]    = random_unit(&seed);
      rhs[k] = z[k] = random_unit(&seed);
    }
    row[N] = column[N];
    s->linearise(s, p);
    assert_true(s->factor(s, p, column, row));
    assert_true(s->solve(s, z));
    dense_system(&f, p, column, row, a);
    for (int j = 0; j <= N; j++)
      for (int k = 0; k <= N; k++) rhs[k] -= a[j * (N + 1) + k] * z[j];
    print_message("|x| %.0e: residual of the system %.1e\n", size[i], mhb_norm(rhs, N + 1));
    assert_below(mhb_norm(rhs, N + 1), 1e-10 * mhb_norm(z, N + 1));
    assert_int_equal(s->sign(s), sign_of_determinant(a));
    tear_down(&f);
  }
}

/* A point owns its evaluation: another point may be linearised in between. */
static void factors_are_those_of_the_point(void **state) {
  (void)state;
  fixture f;
  set_up(&f, MHB_IN_FREQUENCY, 0.3, 0.9, 2);
  mhb_curve_system *s = f.curve->system;
  mhb_curve_point  *p = &f.curve->current, *q = &f.curve->next;
  double            column[N + 1] = {1}, row[N + 1] = {0}, z[2][N + 1];
  row[3] = 1;
  set_random(p, 0.3, 1.3, 7);
  set_random(q, 0.5, 1.7, 8);
  s->linearise(s, p);
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k <= N; k++) z[i][k] = cos(k);
    if (i) s->linearise(s, q);
    assert_true(s->factor(s, p, column, row) && s->solve(s, z[i]));
  }
  assert_below(norm_of_difference(z[0], z[1], N + 1), 1e-13 * mhb_norm(z[0], N + 1));
  tear_down(&f);
}

static void a_row_of_zeros_is_singular(void **state) {
  (void)state;
  fixture f;
  set_up(&f, MHB_IN_FREQUENCY, 0.3, 0.9, 2);
  mhb_curve_system *s             = f.curve->system;
  double            column[N + 1] = {1}, row[N + 1] = {0};
  set_random(&f.curve->current, 0.3, 1.3, 7);
  s->linearise(s, &f.curve->current);
  assert_false(s->factor(s, &f.curve->current, column, row));
  tear_down(&f);
}

/* ---- the linear regime ---- */

/* All pairs stick at a high preload: the step without the law leads where Newton's method does. */
static void the_linear_step_is_that_of_newton(void **state) {
  (void)state;
  fixture f;
  set_up(&f, MHB_IN_FREQUENCY, 60, 0.9, 2);
  mhb_curve_system *s = f.curve->system;
  double            x[N], wanted[N], value = 0;
  assert_true(s->start_of_newton(s, 1.2, 1, x));
  assert_int_equal(mhb_arclength_start(f.curve, x, 1.2, 1), MHB_CONVERGED);
  mhb_curve_point *current = &f.curve->current, *next = &f.curve->next;
  assert_true(s->is_linear(s, current));
  for (int linear = 0; linear < 2; linear++) {
    for (int i = 0; i < N; i++) next->x[i] = current->x[i] + 0.03 * current->tangent[i];
    next->value = current->value + 0.03 * current->tangent[N];
    if (!linear) {
      assert_true(mhb_arclength_correct(f.curve, current->tangent, 1, next));
      memcpy(wanted, next->x, sizeof wanted);
      value = next->value;
      continue;
    }
    assert_true(s->correct_linear(f.curve, current, current->tangent, next));
    assert_below(next->residual, f.curve->roundoff_level);
    print_message("linear step: %d iterations, x off by %.1e\n", next->iterations,
                  norm_of_difference(wanted, next->x, N) / mhb_norm(wanted, N));
    assert_below(norm_of_difference(wanted, next->x, N), 1e-8 * mhb_norm(wanted, N));
    assert_near(next->value, value, 1e-9);
  }
  tear_down(&f);
}

/* At rest all pairs stick; the solution there slips, so the regime does not hold. */
static void the_linear_step_refuses_slip(void **state) {
  (void)state;
  fixture f;
  set_up(&f, MHB_IN_FREQUENCY, 0.02, 0.9, 2);
  mhb_curve_system *s             = f.curve->system;
  mhb_curve_point  *rest          = &f.curve->current;
  double            normal[N + 1] = {0};
  normal[N]                       = 1;
  rest->value                     = 1.3;
  s->linearise(s, rest);
  assert_true(s->is_linear(s, rest));
  f.curve->next.value = 1.3;
  assert_false(s->correct_linear(f.curve, rest, normal, &f.curve->next));
  set_random(rest, 0.3, 1.3, 7);
  s->linearise(s, rest);
  assert_false(s->is_linear(s, rest));
  tear_down(&f);
}

/* ---- the rest of the system ---- */

static void newton_starts_from_two_limits(void **state) {
  (void)state;
  fixture f;
  set_up(&f, MHB_IN_FREQUENCY, 0.3, 0.9, 2);
  mhb_curve_system *s = f.curve->system;
  double            x[N], limit[N];
  for (int which = 0; which < 2; which++) {
    assert_true(s->start_of_newton(s, 1.4, which, x));
    mhb_balance_use(f.balance, NULL);
    assert_ok(mhb_balance_linear_limit(f.balance, 1.4, which, limit));
    assert_memory_equal(x, limit, sizeof x);
  }
  assert_false(s->start_of_newton(s, 1.4, 2, x));
  memcpy(f.curve->next.x, x, sizeof x);
  f.curve->next.value = 1.4;
  assert_int_equal(s->solve_at_value(s, 1e-11, &f.curve->next), MHB_CONVERGED);
  s->linearise(s, &f.curve->next);
  assert_below(mhb_norm(f.curve->next.r, N), 1e-10 * mhb_norm(f.curve->next.x, N));
  assert_true(f.curve->next.value == 1.4);
  tear_down(&f);
}

/* What the steps may use depends on the parameter. */
static void options_follow_the_parameter(void **state) {
  (void)state;
  for (int i = 0; i < 4; i++) {
    fixture f;
    set_up(&f, PARAMETERS[i].parameter, 0.3, PARAMETERS[i].low, PARAMETERS[i].high);
    const mhb_curve_system *s         = f.curve->system;
    bool                    frequency = i == 0;
    assert_true(s->relative == frequency);
    assert_true((s->correct_linear != NULL) == frequency);
    assert_true((s->resonance_step_limit != NULL) == frequency);
    assert_true((s->resonance_skipped != NULL) == frequency);
    assert_true((s->unit_of_value != NULL) == (PARAMETERS[i].parameter == MHB_IN_N0));
    assert_true(s->least == mhb_parameter_least(PARAMETERS[i].parameter));
    assert_ptr_equal(mhb_curve_balance(f.curve), f.balance);
    assert_int_equal(s->row_length, 2 * H + 1);
    assert_int_equal(s->copies, 1);
    tear_down(&f);
  }
}

/* 4 max(|n0|, kv |x|); without both the whole range. */
static void the_unit_of_a_preload(void **state) {
  (void)state;
  fixture f;
  set_up(&f, MHB_IN_N0, 0.3, -1, 1);
  mhb_curve_system *s = f.curve->system;
  mhb_curve_point  *p = &f.curve->current;
  assert_true(isinf(s->unit_of_value(s, p)));
  p->value = -0.5;
  assert_near(s->unit_of_value(s, p), 2, 1e-15);
  p->x[4] = 3;
  assert_near(s->unit_of_value(s, p), 4 * f.settings.kv * 3, 1e-14);
  tear_down(&f);
}

/* A coarse law has no chord steps, and its round-off is higher. */
static void a_coarse_law_is_not_smooth(void **state) {
  (void)state;
  static const double tolerance[] = {1e-10, 1e-5, 1e-3};
  for (int i = 0; i < 3; i++) {
    fixture        f;
    mhb_balance   *coarse;
    mhb_arclength *curve;
    set_up(&f, MHB_IN_FREQUENCY, 0.3, 0.9, 2);
    f.settings.tolerance = tolerance[i];
    assert_ok(mhb_balance_create(&f.model, &f.settings, &coarse));
    curve = mhb_balance_curve_create(coarse, 0.9, 2);
    assert_true(curve->system->smooth == (i < 2));
    assert_near(curve->roundoff_level, fmax(1e-8, 0.1 * tolerance[i]), 1e-20);
    mhb_arclength_destroy(curve);
    mhb_balance_destroy(coarse);
    tear_down(&f);
  }
}

/* Copies of a motion of order 3: a shift by one period three times is none. */
static void copies_are_shifts_by_a_period(void **state) {
  (void)state;
  modal_model        model;
  mhb_settings       settings = random_settings(3);
  mhb_balance       *balance;
  mhb_arclength     *curve;
  unsigned long long seed = 2;
  random_model(1, WITH_LEFT, 4, &model);
  model.n_load          = 1;
  settings.subharmonics = 3;
  settings.blades       = 8;
  assert_ok(mhb_balance_create(&model, &settings, &balance));
  curve                     = mhb_balance_curve_create(balance, 0.9, 2);
  const mhb_curve_system *s = curve->system;
  assert_int_equal(s->copies, 3);
  double x[21], once[21], twice[21], thrice[21];
  for (int i = 0; i < 21; i++) x[i] = random_unit(&seed);
  s->copy(s, x, 1, once);
  s->copy(s, once, 1, twice);
  s->copy(s, twice, 1, thrice);
  assert_below(norm_of_difference(x, thrice, 21), 1e-14);
  assert_true(norm_of_difference(x, once, 21) > 0.1);
  s->copy(s, x, 2, once);
  assert_below(norm_of_difference(once, twice, 21), 1e-14);
  mhb_arclength_destroy(curve);
  mhb_balance_destroy(balance);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_slope_is_the_derivative_by_the_value),
                                     cmocka_unit_test(evaluate_gives_the_same_residual),
                                     cmocka_unit_test(factors_solve_the_dense_system),
                                     cmocka_unit_test(factors_are_those_of_the_point),
                                     cmocka_unit_test(a_row_of_zeros_is_singular),
                                     cmocka_unit_test(the_linear_step_is_that_of_newton),
                                     cmocka_unit_test(the_linear_step_refuses_slip),
                                     cmocka_unit_test(newton_starts_from_two_limits),
                                     cmocka_unit_test(options_follow_the_parameter),
                                     cmocka_unit_test(the_unit_of_a_preload),
                                     cmocka_unit_test(a_coarse_law_is_not_smooth),
                                     cmocka_unit_test(copies_are_shifts_by_a_period)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
