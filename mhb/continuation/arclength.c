#include "mhb/continuation/arclength.h"

#include <math.h>
#include <string.h>

#include "mhb/continuation/corrector.h"

/* Constants of step control, tuned on the 200 curves of tests/hard (stiff contacts, kinks at the
 * onset of slip). Lengths in y, angles in rad. */
static const double FIRST_STEP = 0.02, LARGEST_ANGLE = 0.35, SHORTEST_STEP = 1e-4;
static const double KINK_STEP = 0.02, KINK_RATIO = 0.7;       /* a step is a kink */
static const double NEAR = 0.3, CAREFUL_STEP = 1e-3;          /* jumps to a solution near by */
static const double FAR_ROOM = 0.2, NEAR_ROOM[] = {0.1, 0.3}; /* of an excursion */
static const double FURTHEST_BENT = 2; /* of a step, in units of the last one */
enum {
  WANTED_CORRECTIONS = 5,
  REVERSED_FOR_GOOD  = 10, /* points in a row whose orientation is the other one */
  MAX_EXCURSION      = 1000,
  MAX_RESOLVED       = 8, /* trials of a step that skips resonances */
  NEAR_BUDGET        = 24 /* nonlinear steps of a near excursion that do not head back */
};

/* ---- where a curve starts ---- */

mhb_reason mhb_arclength_start(mhb_arclength *curve, const double *x, double value, int direction) {
  mhb_curve_point *current = &curve->current;
  memcpy(current->x, x, sizeof(double) * (size_t)curve->n);
  current->value    = value;
  curve->step       = FIRST_STEP;
  mhb_reason reason = curve->system->solve_at_value(curve->system, curve->tolerance, current);
  if (reason != MHB_CONVERGED) return reason;
  mhb_arclength_measure(curve, current);
  double *along = curve->chord;
  memset(along, 0, sizeof(double) * (size_t)curve->n);
  along[curve->n] = direction * curve->parameter_scale;
  if (!mhb_arclength_set_tangent(curve, along, current)) return MHB_SINGULAR;
  if (mhb_norm(current->x, curve->n) == 0) { /* |dx/dvalue| over the range becomes the unit */
    const double *t    = current->tangent;
    double        unit = mhb_norm(t, curve->n) / fabs(t[curve->n]) * curve->parameter_scale;
    if (unit > 0 && isfinite(unit)) curve->amplitude_at_rest = unit;
    if (!mhb_arclength_set_tangent(curve, along, current)) return MHB_SINGULAR;
  }
  curve->orientation = current->orientation;
  curve->n_reversed  = 0;
  curve->former_step = 0;
  return MHB_CONVERGED;
}

/* ---- one step of a given length ---- */

/* next <- current + length direction */
static void predict(mhb_arclength *curve, double length, const double *direction) {
  int n = curve->n;
  for (int i = 0; i < n; i++) curve->next.x[i] = curve->current.x[i] + length * direction[i];
  curve->next.value = curve->current.value + length * direction[n];
}

/* Bend the prediction by the curvature of the last step. Its error is then of third order, which
 * saves a correction. */
static void bend(mhb_arclength *curve, double ds) {
  const double *tangent = curve->current.tangent, *former = curve->former_tangent;
  if (curve->former_step == 0 || ds > FURTHEST_BENT * curve->former_step) return;
  const double by = 0.5 * ds * ds / curve->former_step;
  for (int i = 0; i < curve->n; i++) curve->next.x[i] += by * (tangent[i] - former[i]);
  curve->next.value += by * (tangent[curve->n] - former[curve->n]);
}

/* The curve's step from current to next is accepted. After a step that was refused at first the
 * next one is not bent, for it passes kinks. Steps of costly systems are bent all the same. */
static void note_former(mhb_arclength *curve, bool at_once) {
  double chord[curve->n + 1];
  if (!curve->system->bends) return;
  if (!at_once && !curve->system->costly) {
    curve->former_step = 0;
    return;
  }
  for (int i = 0; i < curve->n; i++) chord[i] = curve->next.x[i] - curve->current.x[i];
  chord[curve->n] = curve->next.value - curve->current.value;
  memcpy(curve->former_tangent, curve->current.tangent, sizeof chord);
  curve->former_step = sqrt(mhb_arclength_inner(curve, mhb_arclength_unit(curve), chord, chord));
}

/* next <- the solution a step of length ds away, with its tangent. 0: none was found. If the law is
 * linear at the point tried last, the step without the law is tried first: it is short of a kink
 * then. That point is current, or a refused next. */
static int attempt(mhb_arclength *curve, double ds, const mhb_curve_point *tried) {
  mhb_curve_system *s       = curve->system;
  const double     *tangent = curve->current.tangent;
  int               found   = 0;
  predict(curve, ds, tangent);
  if (s->bends && tried == &curve->current) bend(curve, ds);
  if (s->correct_linear && s->is_linear(s, tried)) {
    found = s->correct_linear(curve, tried, tangent, &curve->next);
    if (!found) predict(curve, ds, tangent);
  }
  if (!found) found = mhb_arclength_correct(curve, tangent, 2 * ds, &curve->next);
  return found && mhb_arclength_set_tangent(curve, tangent, &curve->next);
}

static double angle_between_tangents(const mhb_arclength *curve) {
  double        unit = mhb_arclength_unit(curve);
  const double *a = curve->current.tangent, *b = curve->next.tangent;
  double        length =
      sqrt(mhb_arclength_inner(curve, unit, a, a) * mhb_arclength_inner(curve, unit, b, b));
  return acos(fmax(-1, fmin(1, mhb_arclength_inner(curve, unit, a, b) / length)));
}

/* next lies onwards on the curve, not back along the part that was traced. */
static int keeps_orientation(const mhb_arclength *curve) {
  return curve->next.orientation == curve->orientation;
}

/* A bifurcation reverses the orientation for good. The square-root zone of slip onset reverses it
 * for a few points only. */
static void note_orientation(mhb_arclength *curve) {
  curve->n_reversed = keeps_orientation(curve) ? 0 : curve->n_reversed + 1;
  if (curve->n_reversed < REVERSED_FOR_GOOD) return;
  curve->orientation = curve->next.orientation;
  curve->n_reversed  = 0;
}

mhb_reason mhb_arclength_depart(mhb_arclength *curve, const double *x, double value,
                                const double *along) {
  static const double step[]  = {1e-2, 3e-2, 3e-3, 1e-3};
  mhb_curve_point    *current = &curve->current;
  memcpy(current->x, x, sizeof(double) * (size_t)curve->n);
  current->value     = value;
  curve->former_step = 0;
  mhb_arclength_measure(curve, current);
  double unit = mhb_arclength_unit(curve), length = mhb_norm(along, curve->n) / unit;
  for (int i = 0; i < curve->n; i++) current->tangent[i] = along[i] / length;
  current->tangent[curve->n] = 0;
  for (int i = 0; i < 4; i++) {
    if (!attempt(curve, step[i], i > 0 ? &curve->next : current)) continue;
    double along_it = mhb_arclength_inner(curve, unit, current->tangent, curve->next.tangent);
    if (along_it < 0.5) continue; /* this is the other curve */
    curve->step        = step[i];
    curve->orientation = curve->next.orientation;
    curve->n_reversed  = 0;
    mhb_arclength_advance(curve);
    return MHB_CONVERGED;
  }
  return MHB_NO_DESCENT;
}

/* ---- fallbacks, tried in turn where no ordinary step converges ---- */

/* Beyond a kink the curve may leave in any direction, even back in the value. Its tangent is that
 * of the law a little ahead, as for piecewise linear maps. Its sense keeps the orientation. */
static int step_across_kink(mhb_arclength *curve) {
  static const double ahead[] = {1e-4, 1e-3, 1e-2}, step[] = {1e-3, 3e-3, 1e-2, 3e-4, 1e-4};
  for (int i = 0; i < 15; i++) {
    double ds = step[i / 3];
    predict(curve, ahead[i % 3], curve->current.tangent);
    mhb_arclength_measure(curve, &curve->next);
    if (!mhb_arclength_set_tangent(curve, curve->current.tangent, &curve->next)) continue;
    double sense = keeps_orientation(curve) ? 1 : -1;
    for (int k = 0; k <= curve->n; k++) curve->chord[k] = sense * curve->next.tangent[k];
    predict(curve, ds, curve->chord);
    if (!mhb_arclength_correct(curve, curve->chord, 2 * ds, &curve->next) ||
        !mhb_arclength_set_tangent(curve, curve->chord, &curve->next) || !keeps_orientation(curve))
      continue;
    curve->step = ds;
    return 1;
  }
  return 0;
}

/* In the square-root zone of slip onset larger steps converge where small ones fail. */
static int step_larger(mhb_arclength *curve) {
  static const double larger[] = {3e-3, 1e-2, 3e-2, 0.1};
  for (int i = 0; i < 4; i++) {
    if (!attempt(curve, larger[i], &curve->next) || !keeps_orientation(curve)) continue;
    curve->step = larger[i];
    return 1;
  }
  return 0;
}

/* next <- the solution at next's value from next's x, if it is near current. */
static int solve_near(mhb_arclength *curve) {
  mhb_curve_point *next = &curve->next;
  double           unit = mhb_arclength_unit(curve), far = 0;
  if (curve->system->solve_at_value(curve->system, curve->tolerance, next) != MHB_CONVERGED)
    return 0;
  mhb_arclength_measure(curve, next);
  for (int i = 0; i < curve->n; i++) far = fmax(far, fabs(next->x[i] - curve->current.x[i]) / unit);
  memset(curve->chord, 0, sizeof(double) * (size_t)curve->n); /* onwards in the value */
  curve->chord[curve->n] = next->value - curve->current.value;
  return far < NEAR && mhb_arclength_set_tangent(curve, curve->chord, next);
}

/* The damped Newton method at a value further on, then further back (a cusp). It starts from the
 * current point and from the system's own starts. The last values are very near: where slip ends in
 * two directions at once, the mean friction follows the root of the distance. */
static int step_to_value(mhb_arclength *curve) {
  static const double way[]   = {1e-4, 5e-4, 2e-3, 1e-2, -1e-4, -5e-4, -2e-3, -1e-2, 1e-5, 1e-6};
  mhb_curve_system   *s       = curve->system;
  double              forward = copysign(curve->parameter_scale, curve->current.tangent[curve->n]);
  for (int i = 0; i < 10; i++) {
    double value = curve->current.value + forward * way[i];
    if (value < curve->low || value > curve->high) continue;
    for (int start = -1; start < 2; start++) { /* -1: the current point */
      if (start < 0)
        memcpy(curve->next.x, curve->current.x, sizeof(double) * (size_t)curve->n);
      else if (!s->start_of_newton || !s->start_of_newton(s, value, start, curve->next.x))
        continue;
      curve->next.value = value;
      if (!solve_near(curve) || !keeps_orientation(curve)) continue;
      curve->step = fabs(way[i]) < 1e-4 ? CAREFUL_STEP : FIRST_STEP;
      return 1;
    }
  }
  return 0;
}

/* No point keeps the orientation. This is a bifurcation, or the zone of slip onset, where the
 * orientation is not reliable. */
static int step_reversed(mhb_arclength *curve) {
  static const double step[] = {1e-3, 3e-3, 1e-2, 3e-4};
  for (int i = 0; i < 4; i++) {
    if (!attempt(curve, step[i], &curve->next) || angle_between_tangents(curve) > LARGEST_ANGLE)
      continue;
    curve->step = step[i];
    note_orientation(curve);
    return 1;
  }
  return 0;
}

/* ---- step control ---- */

/* A step of curve->step or shorter, and the length of the next one. 0: none converged. */
static int adaptive_step(mhb_arclength *curve, const mhb_curve_point *tried) {
  double refused = INFINITY; /* the angle at twice this step */
  bool   at_once = true;
  for (; curve->step >= SHORTEST_STEP; tried = &curve->next, at_once = false) {
    double ds = curve->step;
    if (!attempt(curve, ds, tried) || (!keeps_orientation(curve) && curve->n_reversed == 0)) {
      curve->step *= 0.3;
      refused = INFINITY;
      continue;
    }
    double angle = angle_between_tangents(curve);
    bool   kink  = angle > KINK_RATIO * refused && ds <= KINK_STEP;
    if (angle > LARGEST_ANGLE && !kink) {
      refused     = angle;
      curve->step = 0.5 * ds;
      continue;
    }
    double by_work =
        fmax(0.5, fmin(2, (double)WANTED_CORRECTIONS / fmax(1, curve->next.iterations)));
    double by_angle = fmax(0.3, kink ? 1 : 0.6 * LARGEST_ANGLE / fmax(angle, 1e-12));
    curve->step     = fmax(fmin(curve->longest, ds * fmin(by_work, by_angle)), 2 * SHORTEST_STEP);
    note_orientation(curve);
    note_former(curve, at_once);
    return 1;
  }
  if (curve->system->plain) return 0;
  curve->former_step = 0; /* a kink lies between this step and the next */
  return step_across_kink(curve) || step_larger(curve) || step_to_value(curve) ||
         step_reversed(curve);
}

/* A step no longer than ds, however short. At a kink the search begins with ds. If it fails, it
 * begins with the curve's own step. */
static int step_no_longer_than(mhb_arclength *curve, double ds, const mhb_curve_point *tried) {
  double step = curve->step;
  if (ds >= step) return adaptive_step(curve, tried);
  if (attempt(curve, ds, tried) && angle_between_tangents(curve) <= LARGEST_ANGLE &&
      (keeps_orientation(curve) || curve->n_reversed > 0)) {
    note_orientation(curve);
    return 1;
  }
  curve->step = fmax(ds, SHORTEST_STEP);
  if (adaptive_step(curve, &curve->next)) return 1;
  curve->step = step;
  return adaptive_step(curve, &curve->next);
}

/* A step that skips no resonance. The arclength norm contains the contact motion only, so a lightly
 * coupled mode could be stepped over. */
static int resolved_step(mhb_arclength *curve) {
  mhb_curve_system *s    = curve->system;
  double            step = curve->step, rate = curve->current.tangent[curve->n];
  int               orientation = curve->orientation, n_reversed = curve->n_reversed;
  if (!s->resonance_step_limit) return adaptive_step(curve, &curve->current);
  for (int i = 0; i < MAX_RESOLVED; i++) {
    double most = s->resonance_step_limit(s, curve->current.value, rate > 0 ? 1 : -1) / fabs(rate);
    curve->step = step;
    curve->orientation = orientation;
    curve->n_reversed  = n_reversed;
    if (!step_no_longer_than(curve, most, i > 0 ? &curve->next : &curve->current)) return 0;
    if (!s->resonance_skipped(curve)) break;
  }
  return 1;
}

/* next lies beyond an end of the range: solve on the end itself, from the chord. */
static int settle_on(mhb_arclength *curve, double value) {
  mhb_curve_point *current = &curve->current, *next = &curve->next;
  double           part = (value - current->value) / (next->value - current->value);
  memset(curve->chord, 0, sizeof(double) * (size_t)curve->n);
  curve->chord[curve->n] = curve->parameter_scale;
  for (int i = 0; i < curve->n; i++)
    next->x[i] = current->x[i] + part * (next->x[i] - current->x[i]);
  next->value = value;
  int ok      = mhb_arclength_correct(curve, curve->chord, 0.5, next) &&
           mhb_arclength_set_tangent(curve, current->tangent, next);
  next->value = value;
  return ok;
}

mhb_arclength_outcome mhb_arclength_step(mhb_arclength *curve) {
  mhb_curve_system *s = curve->system;
  if (s->unit_of_value) { /* the unit follows the curve; the tangent keeps unit length in it */
    double *tangent        = curve->current.tangent;
    curve->parameter_scale = fmin(curve->high - curve->low, s->unit_of_value(s, &curve->current));
    double length = sqrt(mhb_arclength_inner(curve, mhb_arclength_unit(curve), tangent, tangent));
    for (int i = 0; i <= curve->n; i++) tangent[i] /= length;
  }
  for (int tries = 0; tries < 4; tries++) {
    if (!resolved_step(curve)) break;
    double slack = 1e-12 * fmax(fabs(curve->low), fabs(curve->high));
    bool   above = curve->next.value > curve->high + slack;
    bool   below = curve->next.value < curve->low - slack;
    if (!above && !below) return MHB_ARCLENGTH_ON;
    if (settle_on(curve, above ? curve->high : curve->low))
      return above ? MHB_ARCLENGTH_AT_END : MHB_ARCLENGTH_AT_START;
    curve->step = fmax(SHORTEST_STEP, 0.2 * curve->step);
  }
  return MHB_ARCLENGTH_STALLED;
}

/* ---- outside the range ---- */

/* The longest excursion: frequencies are limited by a factor, other parameters by the range. */
static double room_beyond(const mhb_arclength *curve, int end, mhb_excursion_reach reach) {
  double at = end > 0 ? curve->high : curve->low, half = 0.5 * (curve->high - curve->low);
  bool   relative = curve->system->relative;
  if (reach == MHB_EXCURSION_NEAR)
    return relative ? fmin(fmax(half, NEAR_ROOM[0] * at), NEAR_ROOM[1] * at) : half;
  if (!relative) return (1 / FAR_ROOM - 1) * curve->parameter_scale;
  return end > 0 ? (1 / FAR_ROOM - 1) * at : (1 - FAR_ROOM) * at;
}

bool mhb_arclength_excursion(mhb_arclength *curve, int end, mhb_excursion_reach reach) {
  mhb_curve_system     *s   = curve->system;
  double                low = curve->low, high = curve->high, longest = curve->longest;
  double                at = end > 0 ? high : low, room = room_beyond(curve, end, reach);
  bool                  near    = reach == MHB_EXCURSION_NEAR;
  int                   budget  = near ? NEAR_BUDGET : MAX_EXCURSION;
  mhb_arclength_outcome outcome = MHB_ARCLENGTH_ON;
  if (end > 0)
    curve->high = high + room;
  else
    curve->low = fmax(s->least, low - room);
  if (near) curve->longest = 2 * longest;
  for (int i = 0; outcome == MHB_ARCLENGTH_ON; i++) {
    if (i > 0) mhb_arclength_advance(curve);
    outcome = i < MAX_EXCURSION && budget >= 0 ? mhb_arclength_step(curve) : MHB_ARCLENGTH_STALLED;
    bool inside = end * (curve->next.value - at) <= 0;
    if (outcome == MHB_ARCLENGTH_ON && i > 0 && inside && settle_on(curve, at) &&
        end * curve->next.tangent[curve->n] < 0)
      break;
    bool linear  = s->is_linear && s->is_linear(s, &curve->next);
    bool outward = end * curve->next.tangent[curve->n] > 0;
    if (outward && !linear) budget--;
  }
  curve->low     = low;
  curve->high    = high;
  curve->longest = longest;
  if (near) curve->step = fmin(curve->step, longest);
  return outcome == MHB_ARCLENGTH_ON;
}
