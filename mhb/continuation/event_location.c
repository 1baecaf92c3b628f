#include "mhb/continuation/event_location.h"

#include <math.h>
#include <string.h>

#include "mhb/continuation/corrector.h"

/* Relative widths of a bracket. */
static const double CHORD_FOUND = 1e-9; /* the event is located */
typedef struct {
  double value, chord; /* or by both */
} width;
static const width  FOUND = {1e-10, 1e-4}, FOUND_BRIEFLY = {1e-8, 1e-2};
static const double VALUE_NARROW = 2e-7, CHORD_NARROW = 0.01; /* a kink is the event */
static const double VALUE_BESIDE      = 3e-8;                 /* distance kept from a kink */
static const double VALUE_LAST_RESORT = 1e-4;                 /* accepted if nothing converges */
static const double ROUNDED           = 1e-9;                 /* residual of round-off */
static const double SAME_PLACE        = 1e-3;                 /* part of a bracket */
static const double STEEPEST          = 2; /* length of a curve over its chord, to be bent */
enum {
  BISECTED_FROM = 24, /* from here on by bisection: a test function that jumps misleads Illinois */
  LAG           = 2,  /* where events are brief: steps that Illinois may stay behind bisection */
  MAX_STEPS     = 64,
  MAX_TO_KINK   = 100,
  GUESSES       = 4
};

/* The bracket: its ends, their places on the chord, the test function there. */
typedef struct {
  mhb_arclength         *curve;
  const mhb_curve_point *end[2];
  double                 at[2], g[2];
  double                 relative_value; /* the chord's change of the value, relative */
  int                    guesses; /* that are tried: one, where the event need not be exact */
  int                    guess;   /* which one converged last */
} search;

static void swap_points(mhb_curve_point *a, mhb_curve_point *b) {
  mhb_curve_point old = *a;
  *a                  = *b;
  *b                  = old;
}

/* The trial becomes an end of the bracket. */
static void set_end(search *s, int side, double at) {
  swap_points(&s->curve->trial, &s->curve->bracket[side]);
  s->end[side] = &s->curve->bracket[side];
  s->at[side]  = at;
}

/* trial <- an end of the bracket. */
static int take_end(search *s, int side) {
  mhb_arclength   *curve = s->curve;
  mhb_curve_point *trial = &curve->trial;
  if (s->end[side] == &curve->bracket[side]) {
    swap_points(trial, &curve->bracket[side]);
    return 1;
  }
  memcpy(trial->x, s->end[side]->x, sizeof(double) * (size_t)curve->n);
  trial->value = s->end[side]->value;
  mhb_arclength_measure(curve, trial);
  return mhb_arclength_set_tangent(curve, curve->chord, trial);
}

/* ---- a point at a fraction of the chord ---- */

/* trial lies on the line between the ends, at `part` of the way. The line becomes a cubic with the
 * tangents of both ends, which saves a correction. It stays in the plane. */
static void bend(const search *s, double part) {
  mhb_arclength *curve = s->curve;
  const double   unit = mhb_arclength_unit(curve), length = s->at[1] - s->at[0], rest = 1 - part;
  const double   weight[] = {part * rest * rest, -part * part * rest};
  const double   all      = mhb_arclength_inner(curve, unit, curve->chord, curve->chord) * length;
  double         rate[2];
  for (int side = 0; side < 2; side++) {
    rate[side] = all / mhb_arclength_inner(curve, unit, curve->chord, s->end[side]->tangent);
    if (!(rate[side] > 0 && rate[side] < STEEPEST * sqrt(all * length))) return;
  }
  for (int side = 0; side < 2; side++) {
    const double *t = s->end[side]->tangent, by = weight[side] * rate[side];
    for (int i = 0; i < curve->n; i++) curve->trial.x[i] += by * t[i];
    curve->trial.value += by * t[curve->n];
  }
  const mhb_curve_point *a = s->end[0], *b = s->end[1]; /* the line has these slopes already */
  const double           less = weight[0] + weight[1];
  for (int i = 0; i < curve->n; i++) curve->trial.x[i] -= less * (b->x[i] - a->x[i]);
  curve->trial.value -= less * (b->value - a->value);
}

/* trial <- the solution in the plane across the chord at fraction `at`, from guess `which`:
 *   0     from the line between the ends, bent where events are brief
 *   1, 2  from an end, shifted along the chord
 *   3     from the line, by the damped Newton method at fixed value
 * 0: not converged. */
static int correct_guess(search *s, double at, int which) {
  mhb_arclength         *curve = s->curve;
  mhb_curve_point       *trial = &curve->trial;
  const mhb_curve_point *a = s->end[0], *b = s->end[1];
  int                    kind = which % 3, n = curve->n;
  double                 part = kind == 0 ? (at - s->at[0]) / (s->at[1] - s->at[0]) : kind - 1;
  double                 rest = kind == 0 ? 0 : at - s->at[kind - 1];
  for (int i = 0; i < n; i++)
    trial->x[i] = a->x[i] + part * (b->x[i] - a->x[i]) + rest * curve->chord[i];
  trial->value = a->value + part * (b->value - a->value) + rest * curve->chord[n];
  if (curve->system->brief_events && which == 0) bend(s, part);
  if (which < 3) return mhb_arclength_correct(curve, curve->chord, 1, trial);
  if (curve->system->solve_at_value(curve->system, curve->tolerance, trial) != MHB_CONVERGED)
    return 0;
  mhb_arclength_measure(curve, trial);
  return 1;
}

/* The trial's fraction of the chord. A solution at fixed value need not lie in the plane. */
static double place_of_trial(const search *s) {
  const mhb_arclength *curve = s->curve;
  double               unit  = mhb_arclength_unit(curve), away[curve->n + 1];
  for (int i = 0; i < curve->n; i++) away[i] = curve->trial.x[i] - curve->current.x[i];
  away[curve->n] = curve->trial.value - curve->current.value;
  return mhb_arclength_inner(curve, unit, curve->chord, away) /
         mhb_arclength_inner(curve, unit, curve->chord, curve->chord);
}

/* trial <- the solution in the plane across the chord at fraction *at, and *at its true place. A
 * guess that stopped at round-off is taken if no other converges. Where events are brief it is
 * taken at once. */
static int solve_at(search *s, double *at) {
  mhb_arclength *curve   = s->curve;
  int            rounded = -1;
  for (int i = 0; i < s->guesses; i++) {
    int which = (s->guess + i) % GUESSES;
    if (!correct_guess(s, *at, which)) continue;
    double place = which < 3 ? *at : place_of_trial(s);
    if (!(place > s->at[0] && place < s->at[1])) continue;
    const double enough = curve->system->brief_events && which < 3 ? fmax(ROUNDED, curve->tolerance)
                                                                   : curve->tolerance;
    if (curve->trial.residual <= enough &&
        mhb_arclength_set_tangent(curve, curve->chord, &curve->trial)) {
      s->guess = which;
      *at      = place;
      return 1;
    }
    if (curve->trial.residual <= ROUNDED && rounded < 0) rounded = which;
  }
  return rounded >= 0 && correct_guess(s, *at, rounded) &&
         mhb_arclength_set_tangent(curve, curve->chord, &curve->trial);
}

/* The same at other places of the bracket than *at, where it failed; *at: where it did not. */
static int solve_somewhere(search *s, double *at) {
  static const double other[] = {0.5, 0.2, 0.8, 0.05, 0.95};
  const double        failed = *at, all = s->at[1] - s->at[0];
  for (int i = 0; i < 5; i++) {
    *at = s->at[0] + other[i] * all;
    if (fabs(*at - failed) > SAME_PLACE * all && solve_at(s, at)) return 1;
  }
  return 0;
}

/* ---- kinks: the law is linear on one side ---- */

/* trial <- a point in the plane `ahead` of a linear end, along that end's tangent, corrected in the
 * end's regime. */
static int step_in_regime(search *s, const mhb_curve_point *end, const mhb_curve_point *regime,
                          double ahead) {
  mhb_arclength   *curve  = s->curve;
  mhb_curve_point *trial  = &curve->trial;
  double           unit   = mhb_arclength_unit(curve);
  double           length = mhb_arclength_inner(curve, unit, curve->chord, curve->chord) * ahead /
                  mhb_arclength_inner(curve, unit, curve->chord, end->tangent);
  for (int i = 0; i < curve->n; i++) trial->x[i] = end->x[i] + length * end->tangent[i];
  trial->value = end->value + length * end->tangent[curve->n];
  return curve->system->correct_linear(curve, regime, curve->chord, trial) &&
         mhb_arclength_set_tangent(curve, curve->chord, trial);
}

static bool is_narrow(const search *s) {
  double length = s->at[1] - s->at[0];
  return length < CHORD_NARROW && length * s->relative_value < VALUE_NARROW;
}

/* The side of the bracket that is linear, if the other is not; else -1. */
static int linear_side(const search *s) {
  mhb_curve_system *system = s->curve->system;
  if (!system->correct_linear) return -1;
  bool linear[2];
  for (int side = 0; side < 2; side++) linear[side] = system->is_linear(system, s->end[side]);
  return linear[0] == linear[1] ? -1 : linear[1];
}

/* Where contacts begin to slip, the slipping side is known only to the root of round-off. Newton's
 * method may fail there, but the linear side is exact. The linear end moves on to the last linear
 * point, in steps that are halved. The test function there decides:
 *   true: the kink is the event. The trial lies VALUE_BESIDE of it on the linear side: negligible
 *         in the value, and far enough for Newton's method to converge.
 *   false: the bracket now ends at the kink. */
static bool locate_at_kink(search *s, mhb_test_function g, void *context) {
  mhb_arclength *curve = s->curve;
  int            side  = linear_side(s);
  if (side < 0) return false;
  double                 start = s->at[side], step = 0.5 * (s->at[1 - side] - s->at[side]);
  const mhb_curve_point *former = s->end[side];
  if (former == &curve->bracket[side]) { /* the slot will be overwritten */
    swap_points(&curve->bracket[side], &curve->bracket[2]);
    former = s->end[side] = &curve->bracket[2];
  }
  for (int i = 0; i < MAX_TO_KINK && fabs(step) > CHORD_FOUND; i++) {
    double at = s->at[side] + step;
    if (at > s->at[0] && at < s->at[1] && step_in_regime(s, s->end[side], former, step))
      set_end(s, side, at);
    else
      step *= 0.5;
  }
  double at_kink = g(curve, s->end[side], context);
  if ((at_kink > 0) == (s->g[side] > 0)) {
    s->g[side] = at_kink;
    if (!is_narrow(s)) return false;
    double way  = start - s->at[side];
    double most = VALUE_BESIDE / fmax(s->relative_value, VALUE_BESIDE);
    double back = copysign(fmin(most, 0.5 * fabs(way)), way);
    if (!step_in_regime(s, s->end[side], former, back)) return take_end(s, side);
    s->at[side] += back;
    return true;
  }
  /* the event lies on the linear side: between the former end and the kink */
  if (s->end[side] == &curve->bracket[side])
    swap_points(&curve->bracket[side], &curve->bracket[1 - side]);
  s->end[1 - side] = s->end[side] == &curve->bracket[side] ? &curve->bracket[1 - side] : former;
  s->at[1 - side]  = s->at[side];
  s->g[1 - side]   = at_kink;
  s->end[side]     = former;
  s->at[side]      = start;
  return false;
}

/* ---- the search ---- */

bool mhb_arclength_locate(mhb_arclength *curve, mhb_test_function g, void *context,
                          double at_current, double at_next, double exact, double *fraction) {
  for (int i = 0; i < curve->n; i++) curve->chord[i] = curve->next.x[i] - curve->current.x[i];
  curve->chord[curve->n] = curve->next.value - curve->current.value;
  double      change     = fabs(curve->chord[curve->n]);
  search      s          = {.curve          = curve,
                            .end            = {&curve->current, &curve->next},
                            .at             = {0, 1},
                            .g              = {at_current, at_next},
                            .relative_value = change / mhb_arclength_size(curve),
                            .guesses        = exact > 0 ? 1 : GUESSES};
  const bool  brief      = curve->system->brief_events;
  const width found      = brief ? FOUND_BRIEFLY : FOUND;
  int         last_side  = -1;
  bool        kink       = true; /* one may yet be the event */
  for (int i = 0; i < MAX_STEPS; i++) {
    double at   = (s.at[0] * s.g[1] - s.at[1] * s.g[0]) / (s.g[1] - s.g[0]);
    bool   late = brief ? s.at[1] - s.at[0] > exp2(LAG - i) : i % 4 == 3 || i >= BISECTED_FROM;
    if (late || !(at > s.at[0] && at < s.at[1])) at = 0.5 * (s.at[0] + s.at[1]);
    bool at_kink = kink && linear_side(&s) >= 0;
    bool solved  = !(at_kink && is_narrow(&s)) && solve_at(&s, &at);
    if (!solved && at_kink) {
      kink      = false;
      *fraction = at;
      if (locate_at_kink(&s, g, context)) return true;
      continue;
    }
    if (!solved && (is_narrow(&s) || !solve_somewhere(&s, &at))) {
      *fraction = s.at[0]; /* as near as Newton's method gets */
      return i > 2 && (s.at[1] - s.at[0]) * s.relative_value < VALUE_LAST_RESORT && take_end(&s, 0);
    }
    double value = g(curve, &curve->trial, context);
    *fraction    = at;
    if (value == 0) return true;
    int    side  = (value > 0) != (s.g[0] > 0);
    double moved = fabs(at - s.at[side]), left;
    /* Illinois: an end that stays twice has its value halved */
    if (side == last_side) s.g[1 - side] *= 0.5;
    s.g[side] = value;
    left      = fmin(s.at[1 - side] > at ? s.at[1 - side] - at : at - s.at[1 - side], moved);
    if (left < fmax(exact, CHORD_FOUND) ||
        (i > 2 && left * s.relative_value < found.value && left < found.chord))
      return true;
    set_end(&s, side, at);
    last_side = side;
  }
  return false;
}
