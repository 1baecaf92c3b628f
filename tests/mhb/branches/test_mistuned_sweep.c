/* Curves of a ring of different blades: harmonics chosen at each point, and the preload in place of
 * the frequency. */
#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/balance/newton.h"
#include "mhb/branches/harmonic_selection.h"
#include "mhb/branches/record.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
#include "tests/support/random_model.h"

enum { N = 4, FINE = 25, NB = 2 * FINE + 1, ALL = 3 * N * NB };

static const double DEVIATION[N] = {0.02, -0.01, 0.015, -0.03};

typedef struct {
  modal_model        blade;
  mhb_settings       settings;
  mhb_mistuned_ring *ring;
} problem;

static void make(problem *g, int harmonics) {
  random_model(1, WITH_LEFT | WITH_RESIDUAL, 3, &g->blade);
  g->settings              = random_settings(harmonics);
  g->settings.blades       = N;
  g->settings.scale        = 2;
  g->settings.stability    = MHB_STABILITY_NEVER;
  g->settings.frequency[0] = 1.25 / SHB_TWO_PI;
  g->settings.frequency[1] = 1.55 / SHB_TWO_PI;
  assert_ok(mhb_mistuned_ring_create(&g->blade, &g->settings, DEVIATION, 1, &g->ring));
  g->settings.ring = g->ring;
}

static void drop(problem *g) {
  mhb_mistuned_ring_destroy(g->ring);
  modal_model_free(&g->blade);
}

static mhb_response *curve_of(const problem *g, const mhb_settings *s, int harmonics) {
  mhb_response *r;
  assert_ok(main_curve(&g->ring->whole, s, harmonics, NULL, &r));
  assert_string_equal(r->branch[0].reason, "end of range");
  return r;
}

/* True error of a point, by the solution of FINE harmonics at its frequency; NAN: there is none
 * near it. */
static double true_error(const mhb_branch *b, int p, mhb_balance *fine, mhb_newton *newton) {
  double x[ALL], away[ALL];
  int    iterations;
  mhb_recorded_motion(b, p, fine, x);
  memcpy(away, x, sizeof away);
  if (mhb_newton_solve(newton, fine, SHB_TWO_PI * b->frequency[p], 1e-11, x, &iterations) !=
      MHB_CONVERGED)
    return NAN;
  for (int i = 0; i < ALL; i++) away[i] -= x[i];
  return mhb_norm(away, ALL) / mhb_balance_vibration(fine, x);
}

/* With harmonics: auto each point is within the tolerance, with as many harmonics as it needs. */
static void harmonics_are_as_many_as_are_needed(void **state) {
  static const double TOLERANCE = 3e-3;
  problem             g;
  mhb_balance        *fine;
  mhb_newton         *newton;
  double              worst = 0;
  int                 n = 0, within = 0, promised = 0, looked_at = 0, least = FINE, most = 0;
  (void)state;
  make(&g, 3);
  g.settings.motion_tolerance = TOLERANCE;
  g.settings.n0[0]            = 0.9; /* stuck at the ends of the range */
  g.settings.frequency[0]     = 1.05 / SHB_TWO_PI;
  g.settings.frequency[1]     = 1.75 / SHB_TWO_PI;
  mhb_response *r             = curve_of(&g, &g.settings, MHB_MOST_HARMONICS);
  mhb_settings  s             = g.settings;
  s.harmonics                 = FINE;
  assert_ok(mhb_balance_create(&g.ring->whole, &s, &fine));
  mhb_balance_set_preload(fine, s.n0[0]);
  newton              = mhb_newton_create(fine->n);
  const mhb_branch *b = &r->branch[0];
  for (int p = 0; p < b->n_points; p += 2) {
    const double error = true_error(b, p, fine, newton);
    least              = b->harmonics[p] < least ? b->harmonics[p] : least;
    most               = b->harmonics[p] > most ? b->harmonics[p] : most;
    promised += b->error_truncation[p] <= TOLERANCE;
    looked_at++;
    if (!(error < 0.1)) continue; /* beside a fold */
    n++;
    within += error <= TOLERANCE;
    worst = fmax(worst, error);
  }
  print_message("%d points of %d, harmonics %d to %d: error at most %.2e, %d within %g (%d told)\n",
                n, looked_at, least, most, worst, within, TOLERANCE, promised);
  assert_true(n >= 0.9 * looked_at && within == n);
  assert_true(promised >= 0.95 * looked_at); /* events keep the harmonics of their step */
  assert_true(least < most);
  assert_below(worst, 2 * TOLERANCE);
  mhb_newton_destroy(newton);
  mhb_balance_destroy(fine);
  mhb_response_destroy(r);
  drop(&g);
}

/* Largest difference of two recorded motions, relative to the larger one. */
static double difference(const mhb_response *r, const mhb_branch *a, int p, const mhb_branch *b,
                         int q) {
  const size_t row  = 3 * (size_t)r->n_pairs * (size_t)(r->n_harmonics + 1);
  double       away = 0, size = 0;
  for (size_t i = 0; i < row; i++) {
    const double complex u = a->motion[(size_t)p * row + i], v = b->motion[(size_t)q * row + i];
    away = fmax(away, cabs(u - v));
    size = fmax(size, cabs(v));
  }
  return away / size;
}

/* A curve along the preload has, at both ends, the motion of sweeps that begin there. */
static void the_preload_leads_from_sweep_to_sweep(void **state) {
  static const double end[] = {0.2, 0.6}, AT = 1.33;
  problem             g;
  (void)state;
  make(&g, 5);
  mhb_settings s      = g.settings;
  s.parameter         = MHB_IN_N0;
  s.n0[0]             = end[0];
  s.frequency[0]      = AT / SHB_TWO_PI;
  s.frequency[1]      = AT / SHB_TWO_PI;
  s.range[0]          = end[0];
  s.range[1]          = end[1];
  mhb_response     *r = curve_of(&g, &s, 5);
  const mhb_branch *b = &r->branch[0];
  double            by_slip[2];
  for (int i = 0; i < 2; i++) {
    mhb_settings at         = g.settings;
    at.n0[0]                = end[i];
    at.frequency[0]         = AT / SHB_TWO_PI;
    mhb_response     *sweep = curve_of(&g, &at, 5);
    const mhb_branch *to    = &sweep->branch[0];
    const int         p     = i ? b->n_points - 1 : 0;
    assert_near(b->value[p], end[i], 1e-12);
    assert_near(to->frequency[0], AT / SHB_TWO_PI, 1e-12);
    by_slip[i] = 0;
    for (int a = 0; a < N; a++) by_slip[i] += to->state[3 * a + MHB_SLIDE] / N;
    print_message("n0 %.1f: %.1e from the sweep, slip for %.2f of the period\n", end[i],
                  difference(r, b, p, to, 0), by_slip[i]);
    assert_below(difference(r, b, p, to, 0), 1e-7);
    mhb_response_destroy(sweep);
  }
  assert_true(by_slip[0] > by_slip[1] + 0.05);
  mhb_response_destroy(r);
  drop(&g);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(harmonics_are_as_many_as_are_needed),
                                     cmocka_unit_test(the_preload_leads_from_sweep_to_sweep)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
