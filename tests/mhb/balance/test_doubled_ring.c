/* The distance of a ring's solution from that with twice the harmonics: GMRES against factors, and
 * the estimate against that solution. */
#include <math.h>
#include <string.h>

#include "mhb/balance/newton.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

enum { N = 5, P = 1, M = 5, LOW = N * 3 * P * (2 * M + 1), HIGH = N * 3 * P * (4 * M + 1) };

typedef struct {
  modal_model        blade;
  mhb_settings       settings;
  mhb_mistuned_ring *ring;
  mhb_balance       *balance;
  mhb_newton        *newton;
  mhb_truncation    *truncation;
} problem;

static void make(problem *g, double n0) {
  const double deviation[N] = {0.05, -0.02, 0, 0.03, -0.06};
  random_model(P, WITH_LEFT | WITH_RESIDUAL | WITH_AREAS, 3, &g->blade);
  g->settings              = random_settings(M);
  g->settings.blades       = N;
  g->settings.engine_order = 2;
  assert_ok(mhb_mistuned_ring_create(&g->blade, &g->settings, deviation, 1, &g->ring));
  g->settings.ring = g->ring;
  assert_ok(mhb_balance_create(&g->ring->whole, &g->settings, &g->balance));
  mhb_balance_set_preload(g->balance, n0);
  g->newton = mhb_newton_create(LOW);
  assert_ok(mhb_truncation_create(g->balance, &g->truncation));
}

static void drop(problem *g) {
  mhb_truncation_destroy(g->truncation);
  mhb_newton_destroy(g->newton);
  mhb_balance_destroy(g->balance);
  mhb_mistuned_ring_destroy(g->ring);
  modal_model_free(&g->blade);
}

/* x[LOW] <- a solution at omega; 0: none from both linear limits. */
static int solve(problem *g, double omega, double *x) {
  int iterations;
  for (int stuck = 0; stuck < 2; stuck++) {
    assert_ok(mhb_balance_linear_limit(g->balance, omega, stuck, x));
    if (mhb_newton_solve(g->newton, g->balance, omega, 1e-11, x, &iterations) == MHB_CONVERGED)
      return 1;
  }
  return 0;
}

/* away[HIGH] <- the solution with 2M harmonics less the one with M in wide[HIGH]; 0: none. */
static int solve_doubled(problem *g, double omega, const double *wide, const double *step,
                         double *away) {
  mhb_newton *newton;
  int         iterations;
  newton = mhb_newton_create(HIGH);
  for (int i = 0; i < HIGH; i++) away[i] = wide[i] + step[i];
  const mhb_reason reason =
      mhb_newton_solve(newton, g->truncation->doubled, omega, 1e-11, away, &iterations);
  for (int i = 0; i < HIGH; i++) away[i] -= wide[i];
  mhb_newton_destroy(newton);
  return reason == MHB_CONVERGED;
}

/* GMRES solves the system that the factors solve, to a tolerance. */
static void check_solution(problem *g) {
  static const double tolerance[] = {1e-2, 1e-6, 1e-11};
  unsigned long long  seed        = 3;
  mhb_truncation     *t           = g->truncation;
  double              rhs[HIGH], exact[HIGH], x[HIGH], left[HIGH];
  for (int i = 0; i < HIGH; i++) rhs[i] = exact[i] = random_unit(&seed);
  assert_true(mhb_condensation_factor(t->system, NULL, NULL));
  assert_true(mhb_condensation_solve(t->system, exact));
  for (int i = 0; i < 3; i++) {
    memcpy(x, rhs, sizeof x);
    assert_true(mhb_doubled_ring_solve(t->ring, tolerance[i], x));
    for (int j = 0; j < HIGH; j++) left[j] = x[j] - exact[j];
    assert_below(mhb_norm(left, HIGH), 100 * tolerance[i] * mhb_norm(exact, HIGH));
  }
}

typedef struct {
  int    n;
  double worst, from_factors; /* error by the distance; difference by the estimate with factors */
} agreement;

/* With the factors of a bordered system, as a curve has them, or of one without a border. */
static void check_at(problem *g, double omega, int bordered, agreement *found) {
  double             x[LOW], column[LOW + 1], row[LOW + 1], away[HIGH], off[HIGH];
  unsigned long long seed = 5;
  mhb_truncation    *t    = g->truncation;
  if (!solve(g, omega, x) || mhb_balance_is_linear(g->balance)) return;
  for (int i = 0; i <= LOW; i++) {
    column[i] = random_unit(&seed);
    row[i]    = random_unit(&seed);
  }
  row[LOW]              = column[LOW];
  mhb_ring_system *ring = g->newton->system->ring;
  assert_true(mhb_ring_system_factor(ring, bordered ? column : NULL, bordered ? row : NULL));
  t->factors           = NULL;
  const double factors = mhb_truncation_error(t, x);
  assert_false(t->by_gmres);
  t->factors         = ring;
  const double error = mhb_truncation_error(t, x);
  assert_true(t->by_gmres);
  assert_int_equal(t->kind, MHB_TRUNCATION_NEWTON);
  found->from_factors = fmax(found->from_factors, fabs(error / factors - 1));
  check_solution(g);
  if (!solve_doubled(g, omega, t->x, t->step, away)) return;
  for (int i = 0; i < HIGH; i++) off[i] = t->step[i] - away[i];
  found->worst = fmax(found->worst, mhb_norm(off, HIGH) / mhb_norm(away, HIGH));
  found->n++;
}

static void the_estimate_is_the_distance(void **state) {
  (void)state;
  for (int bordered = 0; bordered < 2; bordered++) {
    agreement found = {0};
    for (int i = 0; i < 2; i++) {
      problem g = {0};
      make(&g, i ? 0.4 : 0.1);
      for (double omega = 0.7; omega < 2; omega += 0.09) check_at(&g, omega, bordered, &found);
      drop(&g);
    }
    print_message(
        "border %d: %d estimates, off by %.3f of the distance, by %.1e of those with "
        "factors\n",
        bordered, found.n, found.worst, found.from_factors);
    assert_true(found.n >= 15);
    assert_below(found.worst, 0.03);
    assert_below(found.from_factors, 2e-3);
  }
}

/* With factors of a singular system the estimate is that without. */
static void without_factors_it_is_newtons_step(void **state) {
  problem g = {0};
  double  x[LOW], zero[LOW + 1] = {0}, step[HIGH];
  (void)state;
  make(&g, 0.1);
  assert_true(solve(&g, 1.33, x) && !mhb_balance_is_linear(g.balance));
  const double newton = mhb_truncation_error(g.truncation, x);
  memcpy(step, g.truncation->step, sizeof step);
  assert_false(mhb_ring_system_factor(g.newton->system->ring, zero, zero));
  g.truncation->factors = g.newton->system->ring;
  assert_near(mhb_truncation_error(g.truncation, x), newton, 0);
  assert_memory_equal(step, g.truncation->step, sizeof step);
  assert_int_equal(g.truncation->kind, MHB_TRUNCATION_NEWTON);
  drop(&g);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_estimate_is_the_distance),
                                     cmocka_unit_test(without_factors_it_is_newtons_step)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
