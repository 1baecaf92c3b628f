#include "mhb/continuation/first_solution.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mhb/continuation/balance_curve.h"

/* Steps of a curve: with stiff contact each pair adds kinks. 84 pairs of cases/z_notch_blade take
 * 311 with 300 times its contact stiffness. */
enum { MAX_STAGES = 200, STAGES_A_PAIR = 10 };

/* Linearisations after which a search is given up. The hardest of the tests, 20 pairs with stiff
 * contact, takes 3018; one pair of rigid friction with 31 to 63 harmonics 20 to 370. */
enum { MOST_LINEARISED = 4000, LINEARISED_A_PAIR = 800 };

/* Steps of a released balance, the shortest that is tried first, and the length below which they
 * end. Where slip begins corrections converge slowly whatever the step. Numbers of harmonics
 * between lead on sooner than steps that become shorter and shorter. */
enum { MAX_RELEASED = 60 };
static const double BOLD = 0.02, CRAWLS = 1e-3;

/* A softer contact has this part of the stiffness, then the same part of that, so many times. */
static const double SOFTER = 0.25;
enum { MOST_SOFTENED = 4 };

/* One search. The balance's counts of linearisations bound it. */
typedef struct {
  mhb_newton  *newton;
  mhb_balance *b;
  double       tolerance;
  double      *x;          /* [n] m */
  int         *iterations; /* of the last Newton method */
  long         last;       /* count at which it ends */
  mhb_watch   *watcher;
} search;

/* One way to a solution. */
typedef mhb_reason way(const search *s, double omega);

static long last_of(const mhb_balance *b, const mhb_watch *watch) {
  const double most = MOST_LINEARISED + LINEARISED_A_PAIR * (double)b->n_pairs;
  return b->n_linearised + lround(most * watch->share);
}

static bool goes_on(const search *s) {
  return s->b->n_linearised < s->last && !shb_interrupted() &&
         (!s->watcher->go_on || s->watcher->go_on(s->watcher->context));
}

/* The same, as Newton's method and the curves ask it. */
static bool watch(const void *context) {
  return goes_on(context);
}

static mhb_reason newton(const search *s, double omega) {
  if (!goes_on(s)) return MHB_GIVEN_UP;
  s->newton->go_on   = watch;
  s->newton->context = s;
  return mhb_newton_solve(s->newton, s->b, omega, s->tolerance, s->x, s->iterations);
}

/* Whether no more is to be tried. */
static bool is_over(const search *s, mhb_reason reason) {
  return reason == MHB_CONVERGED || !goes_on(s);
}

/* Natural continuation of the preload (Seydel 2010), from one whose linear limit x solves. */
static mhb_reason homotopy(const search *s, double omega, double from) {
  mhb_balance *b  = s->b;
  double       to = b->eval->at.n0, part = 0, step = 0.25;
  double       last[b->n];
  mhb_reason   reason = MHB_MAX_ITERATIONS;
  for (int i = 0; i < MAX_STAGES && part < 1 && step > 1e-5 && goes_on(s); i++) {
    double next = fmin(1, part + step);
    memcpy(last, s->x, sizeof last);
    mhb_balance_set_preload(b, from + next * (to - from));
    reason = newton(s, omega);
    if (reason == MHB_CONVERGED) {
      part = next;
      step *= *s->iterations < 6 ? 2 : 1;
    } else {
      memcpy(s->x, last, sizeof last);
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
static mhb_reason directly(const search *s, double omega) {
  mhb_balance *b        = s->b;
  mhb_reason   reason   = MHB_MAX_ITERATIONS;
  double       n0       = b->eval->at.n0;
  int          order[3] = {n0 > 0, n0 <= 0, MHB_BY_PRELOAD}; /* the likelier limit first */
  for (int i = b->n_interfaces > 1 ? -1 : 0; i < 2; i++) {
    if (mhb_balance_linear_limit(b, omega, order[i < 0 ? 2 : i], s->x) != SHB_OK) continue;
    reason = newton(s, omega);
    if (reason == MHB_CONVERGED) return reason;
  }
  memset(s->x, 0, sizeof(double) * (size_t)b->n);
  return newton(s, omega);
}

/* By homotopy in the preload from the linear limits, the likelier first. */
static mhb_reason by_homotopy(const search *s, double omega) {
  mhb_balance *b      = s->b;
  mhb_reason   reason = MHB_MAX_ITERATIONS;
  for (int i = 0; i < 2 && !is_over(s, reason); i++) {
    int stuck = b->eval->at.n0 > 0 ? 1 - i : i;
    if (mhb_balance_linear_limit(b, omega, stuck, s->x) != SHB_OK) continue;
    mhb_balance_tie_preloads(b, 1);
    reason = homotopy(s, omega, far_preload(b, s->x, stuck));
    mhb_balance_tie_preloads(b, 0);
  }
  return reason;
}

/* x <- the solution at `to`, along the curve from a solution x at `from`. plain: no step is tried
 * where the ordinary ones fail. */
static bool continue_to(const search *s, double from, double to, bool plain) {
  mhb_balance   *b         = s->b;
  mhb_arclength *curve     = mhb_balance_curve_create(b, fmin(from, to), fmax(from, to));
  const int      direction = to > from ? 1 : -1, most = MAX_STAGES + STAGES_A_PAIR * b->n_pairs;
  bool           arrived                       = false;
  mhb_balance_curve_of(curve)->newton->go_on   = watch;
  mhb_balance_curve_of(curve)->newton->context = s;
  curve->system->plain                         = plain;
  bool on = mhb_arclength_start(curve, s->x, from, direction) == MHB_CONVERGED;
  for (int i = 0; i < most && on && !arrived && goes_on(s); i++) {
    mhb_arclength_outcome outcome = mhb_arclength_step(curve);
    int end = outcome == MHB_ARCLENGTH_AT_END ? 1 : outcome == MHB_ARCLENGTH_AT_START ? -1 : 0;
    arrived = end == direction;
    on      = outcome != MHB_ARCLENGTH_STALLED;
    mhb_arclength_advance(curve);
    if (end == -direction) { /* back at `from` */
      on = mhb_arclength_excursion(curve, end, MHB_EXCURSION_FAR);
      mhb_arclength_advance(curve);
    }
  }
  memcpy(s->x, curve->current.x, sizeof(double) * (size_t)b->n);
  mhb_arclength_destroy(curve);
  return arrived;
}

/* Along the curve in the preload, past its folds, from a preload at which the contact is stuck, or
 * open, throughout. */
static mhb_reason by_preload(const search *s, double omega) {
  mhb_balance *b      = s->b;
  double       n0     = b->eval->at.n0;
  mhb_reason   reason = MHB_MAX_ITERATIONS;
  for (int stuck = 1; stuck >= 0 && !is_over(s, reason); stuck--) {
    if (mhb_balance_linear_limit(b, omega, stuck, s->x) != SHB_OK) continue;
    double from = far_preload(b, s->x, stuck);
    mhb_balance_tie_preloads(b, 1);
    mhb_balance_set_parameter(b, MHB_IN_N0);
    bool found = continue_to(s, from, n0, false);
    mhb_balance_set_parameter(b, MHB_IN_FREQUENCY);
    mhb_balance_set_preload(b, n0);
    mhb_balance_tie_preloads(b, 0);
    if (found) reason = newton(s, omega);
  }
  return reason;
}

/* Along the curve in the tangential stiffness from a softer contact, whose kinks are fewer. */
static mhb_reason by_stiffness(const search *s, double omega) {
  mhb_balance *b      = s->b;
  const double ku     = b->eval->at.ku[0];
  mhb_reason   reason = MHB_MAX_ITERATIONS;
  double       part   = SOFTER;
  for (int i = 0; i < MOST_SOFTENED && !is_over(s, reason); i++, part *= SOFTER) {
    mhb_balance_go_to(b, MHB_IN_KU, part * ku);
    if (directly(s, omega) == MHB_CONVERGED) {
      mhb_balance_set_parameter(b, MHB_IN_KU);
      if (continue_to(s, part * ku, ku, false)) reason = MHB_CONVERGED;
    }
    mhb_balance_go_to(b, MHB_IN_KU, ku);
    if (reason == MHB_CONVERGED) reason = newton(s, omega);
  }
  return reason;
}

/* ---- from any motion ---- */

/* r(x) = (1 - value) r(x0) at a fixed frequency: x0 solves it at 0, a solution of the balance at 1.
 * Where x0 is a solution of fewer harmonics r(x0) is what the others are loaded with. */
typedef struct {
  mhb_curve_system base; /* first: the functions of the system get it back */
  const search    *search;
  double           omega;
  double          *start; /* [n] r(x0) */
} released_balance;

static released_balance *released(const mhb_curve_system *system) {
  return (released_balance *)system;
}

static void released_destroy(mhb_curve_system *system) {
  mhb_balance_use(released(system)->search->b, NULL);
  free(released(system)->start);
  free(system);
}

static mhb_evaluation *released_evaluation(mhb_curve_system *system) {
  return mhb_evaluation_create(released(system)->search->b);
}

static void released_discard(mhb_curve_system *system, mhb_evaluation *evaluation) {
  mhb_balance_discard(released(system)->search->b, evaluation);
}

/* With derivative, or the residual alone. */
static void released_residual(mhb_curve_system *system, mhb_curve_point *point, bool derivative) {
  const released_balance *w = released(system);
  mhb_balance            *b = w->search->b;
  goes_on(w->search); /* it is shown; the steps end */
  mhb_balance_use(b, point->evaluation);
  if (derivative)
    mhb_balance_linearise(b, point->x, w->omega, point->r, NULL);
  else
    mhb_balance_evaluate(b, point->x, w->omega, point->r, NULL, NULL);
  for (int i = 0; i < b->n; i++) point->r[i] -= (1 - point->value) * w->start[i];
  if (derivative) memcpy(point->slope, w->start, sizeof(double) * (size_t)b->n);
}

static void released_linearise(mhb_curve_system *system, mhb_curve_point *point) {
  released_residual(system, point, true);
}

static void released_evaluate(mhb_curve_system *system, mhb_curve_point *point) {
  released_residual(system, point, false);
}

static int released_factor(mhb_curve_system *system, const mhb_curve_point *point,
                           const double *column, const double *row) {
  mhb_balance_use(released(system)->search->b, point->evaluation);
  return mhb_condensation_factor(released(system)->search->newton->system, column, row);
}

static int released_solve(mhb_curve_system *system, double *rhs) {
  return mhb_condensation_solve(released(system)->search->newton->system, rhs);
}

static int released_sign(const mhb_curve_system *system) {
  return mhb_condensation_sign(released(system)->search->newton->system);
}

/* It starts at a solution; no step needs another one. */
static mhb_reason released_at_value(mhb_curve_system *system, double tolerance,
                                    mhb_curve_point *point) {
  const int n = system->n;
  released_evaluate(system, point);
  return mhb_norm(point->r, n) <= tolerance * mhb_norm(point->x, n) ? MHB_CONVERGED
                                                                    : MHB_NO_DESCENT;
}

static mhb_arclength *released_create(const search *s, double omega) {
  released_balance *w = shb_alloc_zeroed(1, sizeof *w);
  w->base             = (mhb_curve_system){.n                  = s->b->n,
                                           .least              = -1,
                                           .plain              = true,
                                           .row_length         = s->b->nb,
                                           .copies             = 1,
                                           .destroy            = released_destroy,
                                           .evaluation_create  = released_evaluation,
                                           .evaluation_destroy = released_discard,
                                           .linearise          = released_linearise,
                                           .evaluate           = released_evaluate,
                                           .factor             = released_factor,
                                           .solve              = released_solve,
                                           .sign               = released_sign,
                                           .solve_at_value     = released_at_value};
  w->search           = s;
  w->omega            = omega;
  w->start            = shb_alloc_zeroed((size_t)s->b->n, sizeof(double));
  mhb_newton_bind(s->newton, s->b);
  mhb_balance_evaluate(s->b, s->x, omega, w->start, NULL, NULL);
  return mhb_arclength_create(&w->base, 0, 1);
}

/* x <- a solution, along the curve of the released balance from x. */
static mhb_reason release(const search *s, double omega) {
  mhb_arclength *curve   = released_create(s, omega);
  const int      most    = MAX_RELEASED + STAGES_A_PAIR * s->b->n_pairs;
  bool           arrived = false;
  bool           on      = mhb_arclength_start(curve, s->x, 0, 1) == MHB_CONVERGED;
  for (int i = 0; i < most && on && !arrived && goes_on(s); i++) {
    curve->step                   = fmax(curve->step, BOLD);
    mhb_arclength_outcome outcome = mhb_arclength_step(curve);
    arrived                       = outcome == MHB_ARCLENGTH_AT_END;
    on = arrived || (outcome == MHB_ARCLENGTH_ON && curve->step > CRAWLS);
    mhb_arclength_advance(curve);
  }
  memcpy(s->x, curve->current.x, sizeof(double) * (size_t)s->b->n);
  mhb_arclength_destroy(curve);
  return arrived ? newton(s, omega) : MHB_NO_DESCENT;
}

/* ---- fewer harmonics ---- */

/* The same balance with fewer harmonics, and a search in it. */
typedef struct {
  mhb_settings settings;
  search       search;
  int          iterations;
} smaller_balance;

static void smaller_destroy(smaller_balance *w) {
  if (!w) return;
  free(w->search.x);
  mhb_newton_destroy(w->search.newton);
  mhb_balance_destroy(w->search.b);
  free(w);
}

static shb_status smaller_create(const search *s, int m, smaller_balance **out) {
  smaller_balance *w    = shb_alloc_zeroed(1, sizeof *w);
  w->settings           = *s->b->settings;
  w->settings.harmonics = m;
  search *own           = &w->search;
  *own = (search){.tolerance = s->tolerance, .iterations = &w->iterations, .watcher = s->watcher};
  shb_status status = mhb_balance_create_on(s->b->receptance, &w->settings, &own->b);
  if (status != SHB_OK) {
    smaller_destroy(w);
    return status;
  }
  own->newton = mhb_newton_create(own->b->n);
  own->x      = shb_alloc_zeroed((size_t)own->b->n, sizeof *own->x);
  mhb_balance_set_operating_point(own->b, &s->b->eval->at);
  own->last = last_of(own->b, s->watcher);
  *out      = w;
  return SHB_OK;
}

/* to's x <- from's, with harmonics that are zero or left out. */
static void copy_motion(const search *from, const search *to) {
  const int nb = from->b->nb, wide = to->b->nb, rows = 3 * from->b->n_pairs;
  memset(to->x, 0, sizeof(double) * (size_t)to->b->n);
  for (int i = 0; i < rows; i++)
    memcpy(to->x + i * wide, from->x + i * nb, sizeof(double) * (size_t)(nb < wide ? nb : wide));
}

/* From the solution of fewer harmonics to that of s, over numbers between where that is too far. */
static mhb_reason raise(const search *from, const search *s, double omega) {
  copy_motion(from, s);
  if (from->b->m > s->watcher->harmonics) s->watcher->harmonics = from->b->m;
  mhb_reason reason = newton(s, omega);
  if (!is_over(s, reason)) {
    copy_motion(from, s);
    reason = release(s, omega);
  }
  const int        middle = (from->b->m + s->b->m + 1) / 2;
  smaller_balance *w;
  if (is_over(s, reason) || middle >= s->b->m) return reason;
  if (smaller_create(s, middle, &w) != SHB_OK) return reason;
  if (raise(from, &w->search, omega) == MHB_CONVERGED) reason = raise(&w->search, s, omega);
  smaller_destroy(w);
  return reason;
}

/* Highest harmonic of the load. */
static int highest_driven(const mhb_balance *b) {
  int k = b->m;
  while (k > 0 && !b->receptance->driven[k]) k--;
  return k > 0 ? k : 1;
}

/* Newton's method with half as many harmonics, and so on, then back. Few harmonics cannot follow
 * the kinks of a stiff contact, which hold Newton's method up. */
static mhb_reason by_fewer_harmonics(const search *s, double omega) {
  const int        half   = s->b->m / 2;
  mhb_reason       reason = MHB_MAX_ITERATIONS;
  smaller_balance *w;
  if (half < highest_driven(s->b) || smaller_create(s, half, &w) != SHB_OK) return reason;
  mhb_reason first = directly(&w->search, omega);
  if (!is_over(&w->search, first)) first = by_fewer_harmonics(&w->search, omega);
  if (first == MHB_CONVERGED) reason = raise(&w->search, s, omega);
  smaller_destroy(w);
  return reason;
}

/* From values of the frequency near by, along the curve. */
static mhb_reason by_frequency(const search *s, double omega) {
  static const double elsewhere[] = {0.98, 1.02, 0.95, 1.05, 0.9, 1.1, 0.8, 0.6};
  mhb_reason          reason      = MHB_MAX_ITERATIONS;
  for (int i = 0; i < 8 && !is_over(s, reason); i++) {
    double from = elsewhere[i] * omega;
    if (directly(s, from) != MHB_CONVERGED && by_fewer_harmonics(s, from) != MHB_CONVERGED)
      continue;
    if (!continue_to(s, from, omega, true)) continue;
    reason = newton(s, omega);
  }
  return reason;
}

/* A way may take half of what is left. */
static mhb_reason by(way *go, const search *s, double omega) {
  search part = *s;
  part.last   = s->b->n_linearised + (s->last - s->b->n_linearised) / 2;
  return go(&part, omega);
}

/* The balance's parameter is restored. A first solution is sought with the frequency as value. */
mhb_reason mhb_first_solution_watched(mhb_newton *with, mhb_balance *b, double value,
                                      double tolerance, mhb_watch *watch, double *x,
                                      int *iterations) {
  static way *const ways[]    = {by_fewer_harmonics, by_frequency, by_homotopy, by_preload,
                                 by_stiffness};
  mhb_parameter     parameter = b->parameter;
  search            s         = {with, b, tolerance, x, iterations, last_of(b, watch), watch};
  *iterations                 = 0;
  watch->harmonics            = 0;
  mhb_balance_set_value(b, value);
  mhb_balance_set_parameter(b, MHB_IN_FREQUENCY);
  double     omega  = b->eval->at.omega;
  mhb_reason reason = directly(&s, omega);
  for (size_t i = 0; i < sizeof ways / sizeof *ways && !is_over(&s, reason); i++)
    reason = by(ways[i], &s, omega);
  mhb_balance_set_parameter(b, parameter);
  with->go_on = NULL;
  return reason;
}

mhb_reason mhb_first_solution(mhb_newton *with, mhb_balance *b, double value, double tolerance,
                              double *x, int *iterations) {
  mhb_watch nobody = {.share = 1};
  return mhb_first_solution_watched(with, b, value, tolerance, &nobody, x, iterations);
}
