#include "mhb/continuation/first_solution.h"

#include <math.h>
#include <string.h>

#include "mesh/base/progress.h"
#include "mhb/continuation/balance_curve.h"

/* Steps of a curve: with stiff contact each pair adds kinks. 84 pairs of cases/z_notch_blade take
 * 311 with 300 times its contact stiffness. */
enum { MAX_STAGES = 200, STAGES_A_PAIR = 10 };

/* Natural continuation of the preload (Seydel 2010), from one whose linear limit x solves. */
static mhb_reason homotopy(mhb_newton *newton, mhb_balance *b, double omega, double tolerance,
                           double from, double *x) {
  double     to = b->eval->at.n0, part = 0, step = 0.25;
  double     last[b->n];
  mhb_reason reason = MHB_MAX_ITERATIONS;
  for (int i = 0; i < MAX_STAGES && part < 1 && step > 1e-5 && !shb_interrupted(); i++) {
    double next = fmin(1, part + step);
    int    iterations;
    memcpy(last, x, sizeof last);
    mhb_balance_set_preload(b, from + next * (to - from));
    reason = mhb_newton_solve(newton, b, omega, tolerance, x, &iterations);
    if (reason == MHB_CONVERGED) {
      part = next;
      step *= iterations < 6 ? 2 : 1;
    } else {
      memcpy(x, last, sizeof last);
      step *= 0.4;
    }
  }
  mhb_balance_set_preload(b, to);
  if (part >= 1) return MHB_CONVERGED;
  return reason == MHB_CONVERGED ? MHB_MAX_ITERATIONS : reason; /* out of stages on the way */
}

/* A preload beyond which the linear limit holds: no motion of size x can open it, or close it. */
static double far_preload(const mhb_balance *b, const double *x, int stuck) {
  double size = mhb_norm(x, b->n), most = 0;
  for (int i = 0; i < b->n_interfaces; i++) {
    const mhb_operating_point *own = &b->eval->own[i];
    double friction                = (fabs(own->ku[0]) + fabs(own->ku[2])) / fmax(own->mu, 1e-6);
    double enough                  = 4 * size * (own->kv + (stuck ? friction : 0)) + fabs(own->n0);
    if (b->n_interfaces > 1) enough += fabs(b->eval->at.n0); /* all move by what this one does */
    most = fmax(most, enough);
  }
  return stuck ? most : -most;
}

/* From the linear limits and from zero. */
static mhb_reason directly(mhb_newton *newton, mhb_balance *b, double omega, double tolerance,
                           double *x, int *iterations) {
  mhb_reason reason   = MHB_MAX_ITERATIONS;
  double     n0       = b->eval->at.n0;
  int        order[3] = {n0 > 0, n0 <= 0, MHB_BY_PRELOAD}; /* the likelier limit first */
  for (int i = b->n_interfaces > 1 ? -1 : 0; i < 2; i++) {
    if (mhb_balance_linear_limit(b, omega, order[i < 0 ? 2 : i], x) != SHB_OK) continue;
    reason = mhb_newton_solve(newton, b, omega, tolerance, x, iterations);
    if (reason == MHB_CONVERGED) return reason;
  }
  memset(x, 0, sizeof(double) * (size_t)b->n);
  return mhb_newton_solve(newton, b, omega, tolerance, x, iterations);
}

/* The same, then by homotopy in the preload at this omega. */
static mhb_reason solve_here(mhb_newton *newton, mhb_balance *b, double omega, double tolerance,
                             double *x, int *iterations) {
  mhb_reason reason = directly(newton, b, omega, tolerance, x, iterations);
  for (int i = 0; i < 2 && reason != MHB_CONVERGED; i++) {
    int stuck = b->eval->at.n0 > 0 ? 1 - i : i; /* the likelier limit first */
    if (mhb_balance_linear_limit(b, omega, stuck, x) != SHB_OK) continue;
    mhb_balance_tie_preloads(b, 1);
    reason = homotopy(newton, b, omega, tolerance, far_preload(b, x, stuck), x);
    mhb_balance_tie_preloads(b, 0);
  }
  return reason;
}

/* x <- the solution at `to`, along the curve from a solution x at `from`. */
static bool continue_to(mhb_balance *b, double from, double to, double *x) {
  mhb_arclength *curve;
  const int      direction = to > from ? 1 : -1, most = MAX_STAGES + STAGES_A_PAIR * b->n_pairs;
  bool           arrived = false;
  if (mhb_balance_curve_create(b, fmin(from, to), fmax(from, to), &curve) != SHB_OK) return false;
  bool goes_on = mhb_arclength_start(curve, x, from, direction) == MHB_CONVERGED;
  for (int i = 0; i < most && goes_on && !arrived && !shb_interrupted(); i++) {
    mhb_arclength_outcome outcome = mhb_arclength_step(curve);
    int end = outcome == MHB_ARCLENGTH_AT_END ? 1 : outcome == MHB_ARCLENGTH_AT_START ? -1 : 0;
    arrived = end == direction;
    goes_on = outcome != MHB_ARCLENGTH_STALLED;
    mhb_arclength_advance(curve);
    if (end == -direction) { /* back at `from` */
      goes_on = mhb_arclength_excursion(curve, end, MHB_EXCURSION_FAR);
      mhb_arclength_advance(curve);
    }
  }
  memcpy(x, curve->current.x, sizeof(double) * (size_t)b->n);
  mhb_arclength_destroy(curve);
  return arrived;
}

static mhb_reason by_frequency(mhb_newton *newton, mhb_balance *b, double omega, double tolerance,
                               double *x, int *iterations) {
  static const double elsewhere[] = {0.98, 1.02, 0.95, 1.05, 0.9, 1.1, 0.8, 0.6};
  mhb_reason          reason      = solve_here(newton, b, omega, tolerance, x, iterations);
  for (int i = 0; i < 8 && reason != MHB_CONVERGED && !shb_interrupted(); i++) {
    double from = elsewhere[i] * omega;
    if (solve_here(newton, b, from, tolerance, x, iterations) != MHB_CONVERGED) continue;
    if (!continue_to(b, from, omega, x)) continue;
    reason = mhb_newton_solve(newton, b, omega, tolerance, x, iterations);
  }
  return reason;
}

/* Along the curve in the preload, past its folds, from a preload at which the contact is stuck, or
 * open, throughout. */
static mhb_reason by_preload(mhb_newton *newton, mhb_balance *b, double omega, double tolerance,
                             double *x, int *iterations) {
  double     n0     = b->eval->at.n0;
  mhb_reason reason = MHB_MAX_ITERATIONS;
  for (int stuck = 1; stuck >= 0 && reason != MHB_CONVERGED; stuck--) {
    if (mhb_balance_linear_limit(b, omega, stuck, x) != SHB_OK) continue;
    double from = far_preload(b, x, stuck);
    mhb_balance_tie_preloads(b, 1);
    mhb_balance_set_parameter(b, MHB_IN_N0);
    bool found = continue_to(b, from, n0, x);
    mhb_balance_set_parameter(b, MHB_IN_FREQUENCY);
    mhb_balance_set_preload(b, n0);
    mhb_balance_tie_preloads(b, 0);
    if (found) reason = mhb_newton_solve(newton, b, omega, tolerance, x, iterations);
  }
  return reason;
}

/* The balance's parameter is restored. A first solution is sought with the frequency as value. */
mhb_reason mhb_first_solution(mhb_newton *newton, mhb_balance *b, double value, double tolerance,
                              double *x, int *iterations) {
  mhb_parameter parameter = b->parameter;
  mhb_balance_set_value(b, value);
  mhb_balance_set_parameter(b, MHB_IN_FREQUENCY);
  double     omega  = b->eval->at.omega;
  mhb_reason reason = directly(newton, b, omega, tolerance, x, iterations);
  if (reason != MHB_CONVERGED) reason = by_preload(newton, b, omega, tolerance, x, iterations);
  if (reason != MHB_CONVERGED) reason = by_frequency(newton, b, omega, tolerance, x, iterations);
  mhb_balance_set_parameter(b, parameter);
  return reason;
}
