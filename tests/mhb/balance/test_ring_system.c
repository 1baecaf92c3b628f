/* The balance of a ring of different blades: the travelling wave where they are equal, and the
 * system by blocks against a dense one. */
#include <lapacke.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/modal_error.h"
#include "mhb/balance/newton.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/solution.h"

enum { N = 5, P = 2, M = 3, NB = 2 * M + 1, OWN = 3 * P * NB, ALL = N * OWN };

typedef struct {
  modal_model        blade;
  mhb_settings       settings, of_ring;
  mhb_mistuned_ring *ring;
  mhb_balance       *balance;
  double             rest; /* in: the last residual terms, by which the modes left out are judged,
                            * times this; 0: as they are */
} problem;

static void make(problem *g, const double *deviation) {
  random_model(P, WITH_LEFT | WITH_RESIDUAL | WITH_AREAS, 3, &g->blade);
  for (int i = 0; g->rest > 0 && i < 36 * P * P; i++) g->blade.residual_fourth[i] *= g->rest;
  for (int i = 0; g->rest > 0 && i < 18 * P; i++) g->blade.load_inertia[i] *= g->rest;
  g->settings              = random_settings(M);
  g->settings.blades       = N;
  g->settings.engine_order = 2;
  g->of_ring               = g->settings;
  assert_ok(mhb_mistuned_ring_create(&g->blade, &g->settings, deviation, 1, &g->ring));
  g->of_ring.ring = g->ring;
  assert_ok(mhb_balance_create(&g->ring->whole, &g->of_ring, &g->balance));
  mhb_balance_set_preload(g->balance, g->settings.n0[0]);
}

static void drop(problem *g) {
  mhb_balance_destroy(g->balance);
  mhb_mistuned_ring_destroy(g->ring);
  modal_model_free(&g->blade);
}

/* all[ALL] <- the wave x[OWN] in every contact, harmonic k of contact b times exp(-j k b phase). */
static void spread(const double *x, double phase, double *all) {
  for (int b = 0; b < N; b++)
    for (int row = 0; row < 3 * P; row++) {
      const double *a  = x + row * NB;
      double       *to = all + b * OWN + row * NB;
      to[0]            = a[0];
      for (int k = 1; k <= M; k++) {
        const double complex u = CMPLX(a[2 * k - 1], a[2 * k]) * cexp(-I * k * b * phase);
        to[2 * k - 1]          = creal(u);
        to[2 * k]              = cimag(u);
      }
    }
}

static double norm(int n, const double *x) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += x[i] * x[i];
  return sqrt(sum);
}

static void equal_blades_move_as_a_wave(void **state) {
  const double zero[N] = {0}, phase = SHB_TWO_PI * 2 / N;
  problem      g = {0};
  double       x[OWN], all[ALL], start[ALL], r[ALL];
  int          iterations;
  mhb_newton  *newton;
  (void)state;
  make(&g, zero);
  for (double omega = 0.9; omega < 1.8; omega += 0.31) {
    cold_solution(&g.blade, &g.settings, omega, 1e-12, x);
    spread(x, phase, all);
    mhb_balance_evaluate(g.balance, all, omega, r, NULL, NULL);
    assert_below(norm(ALL, r), 1e-10 * norm(ALL, all));
    /* Newton's method comes back to it from a disturbed ring */
    unsigned long long seed = 4;
    for (int i = 0; i < ALL; i++) start[i] = all[i] * (1 + 1e-3 * random_unit(&seed));
    newton = mhb_newton_create(ALL);
    assert_int_equal(mhb_newton_solve(newton, g.balance, omega, 1e-12, start, &iterations),
                     MHB_CONVERGED);
    for (int i = 0; i < ALL; i++) start[i] -= all[i];
    assert_below(norm(ALL, start), 1e-10 * norm(ALL, all));
    mhb_newton_destroy(newton);
  }
  drop(&g);
}

/* Estimates of the tuned ring at a wave that slips, is stuck or open are those of the wave. A blade
 * that differs has another one. */
static void the_error_by_modes_left_out_is_that_of_the_wave(void **state) {
  const double       phase = SHB_TWO_PI * 2 / N, scale[] = {5, 1e-4, 5}, rest[] = {1e-4, 1e-4, 1};
  static const char *what[] = {"slips", "stuck", "slips, far away"};
  (void)state;
  for (int i = 0; i < 3; i++) {
    double estimate[2];
    for (int different = 0; different < 2; different++) {
      const double    delta[N] = {0.02 * different};
      problem         g        = {.rest = rest[i]};
      double          x[OWN], all[ALL], r[ALL], own_r[OWN];
      mhb_balance    *wave;
      mhb_newton     *newton[2];
      mhb_truncation *truncation[2];
      int             iterations;
      make(&g, delta);
      g.settings.scale = g.of_ring.scale = scale[i];
      mhb_balance_destroy(g.balance);
      assert_ok(mhb_balance_create(&g.ring->whole, &g.of_ring, &g.balance));
      mhb_balance_set_preload(g.balance, g.settings.n0[0]);
      assert_ok(mhb_balance_create(&g.blade, &g.settings, &wave));
      mhb_balance_set_preload(wave, g.settings.n0[0]);
      cold_solution(&g.blade, &g.settings, 1.1, 1e-12, x);
      spread(x, phase, all);
      newton[0] = mhb_newton_create(OWN);
      newton[1] = mhb_newton_create(ALL);
      assert_int_equal(mhb_newton_solve(newton[0], wave, 1.1, 1e-12, x, &iterations),
                       MHB_CONVERGED);
      assert_int_equal(mhb_newton_solve(newton[1], g.balance, 1.1, 1e-12, all, &iterations),
                       MHB_CONVERGED);
      mhb_balance_linearise(wave, x, 1.1, own_r, NULL);
      mhb_balance_linearise(g.balance, all, 1.1, r, NULL);
      assert_ok(mhb_truncation_create(wave, &truncation[0]));
      assert_ok(mhb_truncation_create(g.balance, &truncation[1]));
      assert_true(mhb_condensation_factor(newton[1]->system, NULL, NULL));
      truncation[1]->factors = newton[1]->system->ring;
      mhb_truncation_error(truncation[0], x);
      mhb_truncation_error(truncation[1], all);
      const bool   linear = mhb_balance_is_linear(wave);
      const double own    = mhb_modal_error(wave, x, linear ? NULL : truncation[0]);
      const double ring   = mhb_modal_error(g.balance, all, linear ? NULL : truncation[1]);
      print_message("%s%s: %.6e of the wave, %.6e of the ring, ratio - 1 %.1e\n", what[i],
                    different ? ", one differs" : "", own, ring, ring / own - 1);
      assert_true(own > 0 && linear == (i == 1));
      if (!different) assert_near(ring / own, 1, linear ? 1e-9 : 0.02);
      estimate[different] = ring;
      for (int k = 0; k < 2; k++) {
        mhb_truncation_destroy(truncation[k]);
        mhb_newton_destroy(newton[k]);
      }
      mhb_balance_destroy(wave);
      drop(&g);
    }
    assert_true(fabs(estimate[1] / estimate[0] - 1) > 1e-4);
  }
}

/* x[n] <- the solution of the dense bordered system; returns the sign of the determinant. */
static int solve_dense(const double *J, const double *column, const double *row, double *x) {
  const size_t n     = ALL + 1;
  int         *pivot = calloc(n, sizeof *pivot), sign = 1;
  double      *A = calloc(n * n, sizeof *A);
  for (size_t j = 0; j < ALL; j++) {
    memcpy(A + j * n, J + j * ALL, sizeof(double) * ALL);
    A[j * n + ALL] = row[j];
  }
  memcpy(A + ALL * n, column, sizeof(double) * n);
  assert_int_equal(LAPACKE_dgesv(LAPACK_COL_MAJOR, ALL + 1, 1, A, ALL + 1, pivot, x, ALL + 1), 0);
  for (size_t i = 0; i < n; i++) {
    if (A[i * n + i] < 0) sign = -sign;
    if (pivot[i] != (int)i + 1) sign = -sign;
  }
  free(A);
  free(pivot);
  return sign;
}

/* Slipping, stuck and open contacts side by side. */
static void blocks_are_the_jacobian(void **state) {
  const double       delta[N] = {0.05, -0.02, 0, 0.03, -0.06};
  problem            g        = {0};
  unsigned long long seed     = 9;
  double            *J        = calloc(ALL * ALL, sizeof *J), x[ALL], r[ALL], slope[ALL];
  double             column[ALL + 1], row[ALL + 1], y[ALL + 1], z[ALL + 1], near[ALL], moved[ALL];
  mhb_condensation  *system;
  (void)state;
  make(&g, delta);
  for (int i = 0; i < ALL; i++) x[i] = 0.4 * random_unit(&seed) * (i / OWN == 3 ? 1e-3 : 1);
  for (int a = 0; a < 3 * P; a++) x[OWN + a * NB] = a % 3 ? 0 : -9; /* contact 1 is open */
  for (int i = 0; i <= ALL; i++) {
    column[i] = random_unit(&seed);
    row[i]    = random_unit(&seed);
    y[i] = z[i] = random_unit(&seed);
  }
  row[ALL] = column[ALL] = 0.3;
  mhb_balance_evaluate(g.balance, x, 1.2, r, J, slope);
  assert_int_equal(g.balance->eval->kind[P], MHB_PAIR_OPEN);
  assert_int_equal(g.balance->eval->kind[0], MHB_PAIR_NONLINEAR);
  system = mhb_condensation_create(g.balance);
  assert_true(mhb_condensation_factor(system, column, row));
  assert_true(mhb_condensation_solve(system, y));
  assert_int_equal(mhb_condensation_sign(system), solve_dense(J, column, row, z));
  for (int i = 0; i <= ALL; i++) assert_near(y[i], z[i], 1e-9);
  /* J and the slope by differences */
  const double h = 1e-6;
  for (int i = 0; i < ALL; i++) near[i] = x[i] + h * row[i];
  mhb_balance_evaluate(g.balance, near, 1.2 + h, moved, NULL, NULL);
  double away = 0, size = 0;
  for (int i = 0; i < ALL; i++) {
    double change = slope[i];
    for (int j = 0; j < ALL; j++) change += J[j * ALL + i] * row[j];
    away += pow((moved[i] - r[i]) / h - change, 2);
    size += change * change;
  }
  assert_below(sqrt(away / size), 1e-4);
  mhb_condensation_destroy(system);
  drop(&g);
  free(J);
}

/* Motion of a contact that slips (0), sticks (1) or is open (2). */
static void set_state(int contact, int state, unsigned long long *seed, double *x) {
  double *own = x + contact * OWN;
  for (int i = 0; i < OWN; i++) own[i] = (state == 0 ? 0.4 : 1e-3) * random_unit(seed);
  for (int a = 0; a < 3 * P && state == 2; a++) own[a * NB] = a % 3 ? 0 : -9;
}

/* Largest difference of the system's solution from the dense one, relative. */
static double away_from_dense(problem *g, const double *x, bool bordered, mhb_condensation *system,
                              double *J, unsigned long long seed) {
  const int n = bordered ? ALL + 1 : ALL;
  double    column[ALL + 1], row[ALL + 1], y[ALL + 1], z[ALL + 1], r[ALL], away = 0, size = 0;
  for (int i = 0; i <= ALL; i++) {
    column[i] = random_unit(&seed);
    row[i]    = random_unit(&seed);
    y[i] = z[i] = random_unit(&seed);
  }
  row[ALL] = column[ALL] = 0.3;
  mhb_balance_evaluate(g->balance, x, 1.2, r, J, NULL);
  assert_true(mhb_condensation_factor(system, bordered ? column : NULL, bordered ? row : NULL));
  assert_true(mhb_condensation_solve(system, y));
  if (!bordered) { /* the dense system has a border that does nothing */
    memset(column, 0, sizeof column);
    memset(row, 0, sizeof row);
    column[ALL] = row[ALL] = 1;
  }
  assert_int_equal(mhb_condensation_sign(system), solve_dense(J, column, row, z));
  for (int i = 0; i < n; i++) {
    away = fmax(away, fabs(y[i] - z[i]));
    size = fmax(size, fabs(z[i]));
  }
  return away / size;
}

/* All 3^5 mixes of contacts that slip, stick and are open: from none that is left to all. */
static void every_mix_of_states_is_solved(void **state) {
  const double       delta[N] = {0.05, -0.02, 0, 0.03, -0.06};
  problem            g        = {0};
  unsigned long long seed     = 12;
  double            *J = calloc(ALL * ALL, sizeof *J), x[ALL], worst = 0;
  int                left[N + 1] = {0};
  mhb_condensation  *system;
  (void)state;
  make(&g, delta);
  system = mhb_condensation_create(g.balance);
  for (int mix = 0; mix < 243; mix++) {
    for (int b = 0, rest = mix; b < N; b++, rest /= 3) set_state(b, rest % 3, &seed, x);
    worst = fmax(worst, away_from_dense(&g, x, mix % 2, system, J, seed));
    left[system->ring->linear->n_left]++;
  }
  printf("solutions off by %.1e\n", worst);
  assert_below(worst, 1e-12);
  for (int i = 0; i <= N; i++) assert_true(left[i] > 0);
  mhb_condensation_destroy(system);
  drop(&g);
  free(J);
}

/* The stuck limit solves the balance where the preload holds every contact. */
static void stuck_limit_solves_it(void **state) {
  const double delta[N] = {0.05, -0.02, 0, 0.03, -0.06};
  problem      g        = {0};
  double       x[ALL], r[ALL];
  (void)state;
  make(&g, delta);
  mhb_balance_set_preload(g.balance, 50);
  assert_ok(mhb_balance_linear_limit(g.balance, 1.3, 1, x));
  mhb_balance_evaluate(g.balance, x, 1.3, r, NULL, NULL);
  assert_true(mhb_balance_is_linear(g.balance));
  assert_below(norm(ALL, r), 1e-12 * norm(ALL, x));
  drop(&g);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_error_by_modes_left_out_is_that_of_the_wave),
      cmocka_unit_test(equal_blades_move_as_a_wave), cmocka_unit_test(blocks_are_the_jacobian),
      cmocka_unit_test(every_mix_of_states_is_solved), cmocka_unit_test(stuck_limit_solves_it)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
