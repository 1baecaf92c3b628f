/* Newton's method on the balance: convergence, the linear case in one step, tolerances out of
 * reach. */
#include "mhb/balance/newton.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

typedef struct {
  modal_model  model;
  mhb_settings settings;
  mhb_balance *balance;
  mhb_newton  *newton;
} problem;

static void create(problem *p, double n0) {
  random_model(2, WITH_LEFT | WITH_RESIDUAL, 5, &p->model);
  p->settings = random_settings(5);
  assert_ok(mhb_balance_create(&p->model, &p->settings, &p->balance));
  p->newton = mhb_newton_create(p->balance->n);
  mhb_balance_set_preload(p->balance, n0);
}

static void destroy(problem *p) {
  mhb_newton_destroy(p->newton);
  mhb_balance_destroy(p->balance);
  modal_model_free(&p->model);
}

/* From the stuck limit to a solution with slip; from there no step is needed. */
static void converges(void **state) {
  (void)state;
  problem p;
  int     iterations;
  create(&p, 0.05);
  double x[p.balance->n];
  assert_ok(mhb_balance_linear_limit(p.balance, 1.4, 1, x));
  assert_int_equal(mhb_newton_solve(p.newton, p.balance, 1.4, 1e-11, x, &iterations),
                   MHB_CONVERGED);
  assert_true(iterations > 1 && iterations < 40);
  assert_true(p.balance->eval->info[0].share[MHB_SLIDE] > 0);
  mhb_balance_evaluate(p.balance, x, 1.4, p.newton->r, NULL, NULL);
  assert_below(mhb_norm(p.newton->r, p.balance->n), 1e-11 * mhb_norm(x, p.balance->n));
  assert_int_equal(mhb_newton_solve(p.newton, p.balance, 1.4, 1e-10, x, &iterations),
                   MHB_CONVERGED);
  assert_int_equal(iterations, 0);
  destroy(&p);
}

/* With a large preload all pairs stick: the balance is linear, and one step solves it. */
static void one_step_if_linear(void **state) {
  (void)state;
  problem p;
  int     iterations;
  create(&p, 1e3);
  int    n = p.balance->n;
  double x[n], wanted[n];
  assert_ok(mhb_balance_linear_limit(p.balance, 1.2, 1, wanted));
  for (int i = 0; i < n; i++) x[i] = wanted[i] + 0.01 * (i % 3 - 1);
  assert_int_equal(mhb_newton_solve(p.newton, p.balance, 1.2, 1e-11, x, &iterations),
                   MHB_CONVERGED);
  assert_int_equal(iterations, 1);
  for (int i = 0; i < n; i++) x[i] -= wanted[i];
  assert_below(mhb_norm(x, n), 1e-10 * mhb_norm(wanted, n));
  destroy(&p);
}

/* A residual of exactly zero is out of reach: the search ends, and says so. */
static void tolerance_out_of_reach(void **state) {
  (void)state;
  problem p;
  int     iterations;
  create(&p, 0.4);
  double x[p.balance->n];
  assert_ok(mhb_balance_linear_limit(p.balance, 1.4, 1, x));
  assert_true(mhb_newton_solve(p.newton, p.balance, 1.4, 0, x, &iterations) < 0);
  destroy(&p);
}

/* The condensation is made once for a balance, and anew for another one. */
static void binds(void **state) {
  (void)state;
  problem p, q;
  create(&p, 0.4);
  create(&q, 0.4);
  mhb_newton_bind(p.newton, p.balance);
  const mhb_condensation *first = p.newton->system;
  mhb_newton_bind(p.newton, p.balance);
  assert_ptr_equal(p.newton->system, first);
  mhb_newton_bind(p.newton, q.balance);
  assert_ptr_equal(p.newton->system->balance, q.balance);
  destroy(&q);
  destroy(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(converges),
      cmocka_unit_test(one_step_if_linear),
      cmocka_unit_test(tolerance_out_of_reach),
      cmocka_unit_test(binds),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
