#include "mhb/continuation/arclength.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/continuation/corrector.h"
#include "mhb/continuation/resonance_detection.h"

/* Settings that did not stall on stiff and on kinked curves. */
static const double FIRST_STEP = .02, LONGEST_STEP = .1, LARGEST_ANGLE = .35, SHORTEST_STEP = 1e-4;
static const double NEAR = .3, CAREFUL_STEP = 1e-3;
static const double KINK_STEP = .02, KINK_RATIO = .7;
static const double OUTSIDE = .2, NEAR_ROOM[] = {.1, .3};
enum { WANTED_CORRECTIONS = 5, LASTING = 10, MAX_OUTSIDE = 1000, MAX_LOOKS = 8, PATIENCE = 24 };

static int point_create(mhb_curve_point *point, int n) {
  point->x       = calloc((size_t)n, sizeof(double));
  point->tangent = calloc((size_t)n + 1, sizeof(double));
  return point->x && point->tangent;
}

static void point_free(mhb_curve_point *point) {
  free(point->x);
  free(point->tangent);
}

shb_status mhb_arclength_create(mhb_balance *residual, double low, double high,
                                mhb_arclength **out) {
  mhb_arclength *path = calloc(1, sizeof *path);
  SHB_CHECK(path, SHB_ERR_IO, "out of memory");
  int n           = residual->n;
  path->residual  = residual;
  path->n         = n;
  path->low       = low;
  path->high      = high;
  path->span      = high - low;
  path->least     = mhb_parameter_least(residual->parameter);
  path->rest      = 1;
  path->longest   = LONGEST_STEP;
  path->tolerance = 1e-10;
  path->stagnant  = fmax(1e-8, .1 * residual->settings->tolerance);
  path->chord     = calloc((size_t)n + 1, sizeof(double));
  path->kept      = calloc((size_t)n + 1, sizeof(double));
  for (int i = 0; i < 2; i++) path->bracket[i] = calloc((size_t)n + 1, sizeof(double));
  int ok = path->chord && path->kept && path->bracket[0] && path->bracket[1] &&
           point_create(&path->now, n) && point_create(&path->next, n) &&
           point_create(&path->probe, n) && mhb_newton_create(n, &path->newton) == SHB_OK &&
           mhb_newton_bind(path->newton, residual) == SHB_OK &&
           mhb_linear_corrector_create(residual, &path->still) == SHB_OK;
  if (!ok) {
    mhb_arclength_destroy(path);
    SHB_FAIL(SHB_ERR_IO, "out of memory for a path of %d unknowns", n);
  }
  shb_status status = mhb_resonances_create(residual, low, high, &path->resonances);
  if (status != SHB_OK) {
    mhb_arclength_destroy(path);
    return status;
  }
  *out = path;
  return SHB_OK;
}

void mhb_arclength_destroy(mhb_arclength *path) {
  if (!path) return;
  point_free(&path->now);
  point_free(&path->next);
  point_free(&path->probe);
  mhb_newton_destroy(path->newton);
  mhb_linear_corrector_destroy(path->still);
  mhb_resonances_destroy(&path->resonances);
  free(path->chord);
  free(path->kept);
  for (int i = 0; i < 2; i++) free(path->bracket[i]);
  free(path);
}

/* From rest: |dx/dvalue| span, whatever the unit of the tangent. */
static void set_unit_of_rest(mhb_arclength *path) {
  const double *t    = path->now.tangent;
  double        unit = mhb_norm(t, path->n) / fabs(t[path->n]) * path->span;
  if (unit > 0 && isfinite(unit)) path->rest = unit;
}

mhb_reason mhb_arclength_start(mhb_arclength *path, const double *x, double value, int direction) {
  memcpy(path->now.x, x, sizeof(double) * (size_t)path->n);
  path->now.value   = value;
  path->step        = FIRST_STEP;
  mhb_reason reason = mhb_newton_solve(path->newton, path->residual, value, path->tolerance,
                                       path->now.x, &path->now.iterations);
  if (reason != MHB_CONVERGED) return reason;
  mhb_arclength_measure(path, &path->now);
  double *along = path->chord;
  memset(along, 0, sizeof(double) * (size_t)path->n);
  along[path->n] = direction * path->span;
  if (!mhb_arclength_set_tangent(path, along, &path->now)) return MHB_SINGULAR;
  if (mhb_norm(path->now.x, path->n) == 0) {
    set_unit_of_rest(path);
    if (!mhb_arclength_set_tangent(path, along, &path->now)) return MHB_SINGULAR;
  }
  path->orientation = path->now.orientation;
  path->against     = 0;
  return MHB_CONVERGED;
}

static void predict(mhb_arclength *path, double ds) {
  for (int i = 0; i < path->n; i++) path->next.x[i] = path->now.x[i] + ds * path->now.tangent[i];
  path->next.value = path->now.value + ds * path->now.tangent[path->n];
}

/* next <- now + ds tangent, corrected. */
static int attempt(mhb_arclength *path, double ds) {
  predict(path, ds);
  int ok = mhb_linear_set_states(path->still, path->residual) &&
           mhb_arclength_correct_still(path, path->now.tangent, &path->next);
  if (!ok) predict(path, ds);
  return (ok || mhb_arclength_correct(path, path->now.tangent, 2 * ds, &path->next)) &&
         mhb_arclength_set_tangent(path, path->now.tangent, &path->next);
}

static double angle_between(const mhb_arclength *path) {
  double scale = mhb_arclength_unit(path), *a = path->now.tangent, *b = path->next.tangent;
  double length =
      sqrt(mhb_arclength_inner(path, scale, a, a) * mhb_arclength_inner(path, scale, b, b));
  double cosine = mhb_arclength_inner(path, scale, a, b) / length;
  return acos(fmax(-1, fmin(1, cosine)));
}

/* next <- a solution at fixed value, Newton damped, from a guess that may be far; kept if it is near now. */
static int attempt_from(mhb_arclength *path, double value, const double *guess) {
  mhb_curve_point *next = &path->next;
  size_t           size = sizeof(double) * (size_t)path->n;
  memcpy(next->x, guess, size);
  next->value = value;
  if (mhb_newton_solve(path->newton, path->residual, value, path->tolerance, next->x,
                       &next->iterations) != MHB_CONVERGED)
    return 0;
  mhb_arclength_measure(path, next);
  double scale = mhb_arclength_unit(path), far = 0;
  for (int i = 0; i < path->n; i++) far = fmax(far, fabs(next->x[i] - path->now.x[i]) / scale);
  memset(path->chord, 0, size); /* onwards in frequency */
  path->chord[path->n] = value - path->now.value;
  return far < NEAR && mhb_arclength_set_tangent(path, path->chord, next);
}

mhb_reason mhb_arclength_depart(mhb_arclength *path, const double *x, double value,
                                const double *along) {
  static const double step[] = {1e-2, 3e-2, 3e-3, 1e-3};
  mhb_curve_point    *now    = &path->now;
  memcpy(now->x, x, sizeof(double) * (size_t)path->n);
  now->value   = value;
  double scale = mhb_arclength_unit(path), length = mhb_norm(along, path->n) / scale;
  for (int i = 0; i < path->n; i++) now->tangent[i] = along[i] / length;
  now->tangent[path->n] = 0;
  for (int i = 0; i < 4; i++) {
    if (!attempt(path, step[i])) continue;
    double gone = mhb_arclength_inner(path, scale, now->tangent, path->next.tangent);
    if (gone < .5) continue; /* along the curve that is left */
    path->step        = step[i];
    path->orientation = path->next.orientation;
    path->against     = 0;
    mhb_arclength_advance(path);
    return MHB_CONVERGED;
  }
  return MHB_NO_DESCENT;
}

/* The path goes on through next, rather than back along what was passed. */
static int goes_on(const mhb_arclength *path) {
  return path->next.orientation == path->orientation;
}

/* A bifurcation turns the orientation for good; the square-root zone of slip onset for a few points only. */
static void note_orientation(mhb_arclength *path) {
  path->against = path->next.orientation == path->orientation ? 0 : path->against + 1;
  if (path->against < LASTING) return;
  path->orientation = path->next.orientation;
  path->against     = 0;
}

/* Past a kink the path may leave in any direction, even back in frequency. Its tangent is that of the law at a place ahead,
 * taken in the sense that keeps the orientation, as in the continuation of piecewise linear maps. */
static int attempt_across(mhb_arclength *path, double ahead, double ds) {
  mhb_curve_point *now = &path->now, *next = &path->next;
  int              one = path->n + 1;
  for (int i = 0; i < path->n; i++) next->x[i] = now->x[i] + ahead * now->tangent[i];
  next->value = now->value + ahead * now->tangent[path->n];
  mhb_arclength_evaluate(path, next);
  if (!mhb_arclength_set_tangent(path, now->tangent, next)) return 0;
  double sense = goes_on(path) ? 1 : -1;
  for (int i = 0; i < one; i++) path->chord[i] = sense * next->tangent[i];
  for (int i = 0; i < path->n; i++) next->x[i] = now->x[i] + ds * path->chord[i];
  next->value = now->value + ds * path->chord[path->n];
  return mhb_arclength_correct(path, path->chord, 2 * ds, next) &&
         mhb_arclength_set_tangent(path, path->chord, next) && goes_on(path);
}

static int across_kink(mhb_arclength *path) {
  static const double ahead[] = {1e-4, 1e-3, 1e-2}, step[] = {1e-3, 3e-3, 1e-2, 3e-4, 1e-4};
  for (int i = 0; i < 15; i++) {
    if (!attempt_across(path, ahead[i % 3], step[i / 3])) continue;
    path->step = step[i / 3];
    return 1;
  }
  return 0;
}

/* Where small steps fail (the square-root zone at slip onset), larger ones pass; else the damped Newton at a fixed
 * value further on, then further back (a cusp), from the old point and from the linear limits. Then very near: where slip
 * ends in two directions at once, the lens of admissible mean frictions opens, and the mean leaves, with the root of the distance. */
static int last_resort(mhb_arclength *path) {
  const double larger[] = {3e-3, 1e-2, 3e-2, .1},
               way[]    = {1e-4, 5e-4, 2e-3, 1e-2, -1e-4, -5e-4, -2e-3, -1e-2, 1e-5, 1e-6};
  enum { WAYS = sizeof way / sizeof *way };
  for (int i = 0; i < 4; i++) {
    if (!attempt(path, larger[i]) || !goes_on(path)) continue;
    path->step = larger[i];
    return 1;
  }
  double guess[path->n], forward = copysign(path->span, path->now.tangent[path->n]);
  for (int i = 0; i < 3 * WAYS; i++) {
    double value = path->now.value + forward * way[i / 3];
    int    stuck = i % 3 - 1; /* -1: the old point */
    if (value < path->low || value > path->high) continue;
    if (stuck < 0) {
      memcpy(guess, path->now.x, sizeof guess);
    } else if (mhb_balance_linear_limit(path->residual, value, stuck, guess) != SHB_OK) {
      continue;
    }
    if (!attempt_from(path, value, guess) || !goes_on(path)) continue;
    path->step = fabs(way[i / 3]) < 1e-4 ? CAREFUL_STEP : FIRST_STEP;
    return 1;
  }
  return 0;
}

/* Nothing keeps the orientation: a bifurcation, or the zone of slip onset where it cannot be trusted. */
static int turned(mhb_arclength *path) {
  static const double step[] = {1e-3, 3e-3, 1e-2, 3e-4};
  for (int i = 0; i < 4; i++) {
    if (!attempt(path, step[i]) || angle_between(path) > LARGEST_ANGLE) continue;
    path->step = step[i];
    note_orientation(path);
    return 1;
  }
  return 0;
}

static int find_next(mhb_arclength *path) {
  double refused = INFINITY; /* angle at twice this step */
  while (path->step >= SHORTEST_STEP) {
    double ds = path->step;
    if (!attempt(path, ds)) {
      path->step *= .3;
      refused = INFINITY;
      continue;
    }
    if (!goes_on(path) && path->against == 0) {
      path->step *= .3;
      refused = INFINITY;
      continue;
    }
    double angle = angle_between(path);
    int    kink  = angle > KINK_RATIO * refused && ds <= KINK_STEP;
    if (angle > LARGEST_ANGLE && !kink) {
      refused    = angle;
      path->step = .5 * ds;
      continue;
    }
    double by_work  = (double)WANTED_CORRECTIONS / fmax(1, path->next.iterations);
    double by_angle = kink ? 1 : .6 * LARGEST_ANGLE / fmax(angle, 1e-12);
    path->step = fmin(path->longest, ds * fmin(fmax(.5, fmin(2, by_work)), fmax(.3, by_angle)));
    path->step = fmax(path->step, 2 * SHORTEST_STEP);
    note_orientation(path);
    return 1;
  }
  return across_kink(path) || last_resort(path) || turned(path);
}

/* A step of length ds, however short; path->step stays. 0: no ordinary point there. */
static int short_step(mhb_arclength *path, double ds) {
  if (!attempt(path, ds) || angle_between(path) > LARGEST_ANGLE) return 0;
  if (!goes_on(path) && path->against == 0) return 0;
  note_orientation(path);
  return 1;
}

/* The same; else, at a kink, one that begins with ds, and at worst with the path's own. */
static int at_most(mhb_arclength *path, double ds) {
  double step = path->step;
  if (ds >= step) return find_next(path);
  if (short_step(path, ds)) return 1;
  path->step = fmax(ds, SHORTEST_STEP);
  if (find_next(path)) return 1;
  path->step = step;
  return find_next(path);
}

/* next: a step that does not pass over a resonance that is felt. */
static int find_resolved(mhb_arclength *path) {
  double step = path->step, along = path->now.tangent[path->n];
  int    orientation = path->orientation, against = path->against;
  for (int i = 0; i < MAX_LOOKS; i++) {
    double way = mhb_resonances_step_limit(&path->resonances, path->now.value, along > 0 ? 1 : -1);
    path->step = step;
    path->orientation = orientation;
    path->against     = against;
    if (!at_most(path, way / fabs(along))) return 0;
    if (!mhb_resonance_skipped(path)) break;
  }
  return 1;
}

/* next went past an end of the range: solve on the end itself, from the chord. */
static int settle_on(mhb_arclength *path, double value) {
  double part = (value - path->now.value) / (path->next.value - path->now.value);
  double axis[path->n + 1];
  memset(axis, 0, sizeof(double) * (size_t)path->n);
  axis[path->n] = path->span;
  for (int i = 0; i < path->n; i++)
    path->next.x[i] = path->now.x[i] + part * (path->next.x[i] - path->now.x[i]);
  path->next.value = value;
  int ok           = mhb_arclength_correct(path, axis, .5, &path->next) &&
           mhb_arclength_set_tangent(path, path->now.tangent, &path->next);
  path->next.value = value;
  return ok;
}

/* A preload is measured by itself or by what the motion does to the normal force, whichever is more: where the contact opens and slips
 * must not be stepped over in a range that is far wider. */
static void set_unit_of_preload(mhb_arclength *path) {
  static const double WIDE  = 4;
  mhb_curve_point    *now   = &path->now;
  double              scale = mhb_arclength_unit(path),
         moved              = path->residual->eval->at.kv * mhb_norm(now->x, path->n),
         own                = WIDE * fmax(fabs(now->value), moved);
  path->span                = fmin(path->high - path->low, own > 0 ? own : INFINITY);
  double length             = sqrt(mhb_arclength_inner(path, scale, now->tangent, now->tangent));
  for (int i = 0; i <= path->n; i++) now->tangent[i] /= length;
}

mhb_arclength_outcome mhb_arclength_step(mhb_arclength *path) {
  if (path->residual->parameter == MHB_IN_N0) set_unit_of_preload(path);
  for (int tries = 0; tries < 4; tries++) {
    if (!find_resolved(path)) break;
    double slack = 1e-12 * fmax(fabs(path->low), fabs(path->high));
    int above = path->next.value > path->high + slack, below = path->next.value < path->low - slack;
    if (!above && !below) return MHB_ARCLENGTH_ON;
    if (settle_on(path, above ? path->high : path->low))
      return above ? MHB_ARCLENGTH_AT_END : MHB_ARCLENGTH_AT_START;
    path->step = fmax(SHORTEST_STEP, .2 * path->step);
  }
  return MHB_ARCLENGTH_STALLED;
}

/* next has come back to the end of the range: set it on the end, heading inwards. */
static int back_at(mhb_arclength *path, double end, int inwards) {
  if (inwards * (path->next.value - end) < 0) return 0;
  return settle_on(path, end) && inwards * path->next.tangent[path->n] > 0;
}

/* Room beyond the end that the path has come to: frequencies by a factor, other parameters by some spans. */
static double far_room(const mhb_arclength *path, double end, int inwards) {
  if (path->residual->parameter != MHB_IN_FREQUENCY) return (1 / OUTSIDE - 1) * path->span;
  return inwards > 0 ? (1 - OUTSIDE) * end : (1 / OUTSIDE - 1) * end;
}

static double near_room(const mhb_arclength *path, double end) {
  double half = .5 * (path->high - path->low);
  if (path->residual->parameter != MHB_IN_FREQUENCY) return half;
  return fmin(fmax(half, NEAR_ROOM[0] * end), NEAR_ROOM[1] * end);
}

static bool is_linear(const mhb_arclength *path) {
  const mhb_balance *b = path->residual;
  for (int i = 0; i < b->n_pairs; i++)
    if (b->eval->info[i].share[0] < 1 && b->eval->info[i].share[2] < 1) return false;
  return true;
}

/* On from now until the path is back on the end, with a budget of steps on which a contact moves and the way is not back. */
static mhb_arclength_outcome excursion(mhb_arclength *path, int inwards, double room, int budget) {
  double                low = path->low, high = path->high, end = inwards > 0 ? low : high;
  mhb_arclength_outcome way = MHB_ARCLENGTH_ON;
  if (inwards > 0)
    path->low = fmax(path->least, low - room);
  else
    path->high = high + room;
  for (int i = 0; way == MHB_ARCLENGTH_ON; i++) {
    if (i > 0) mhb_arclength_advance(path);
    way = i < MAX_OUTSIDE && budget >= 0 ? mhb_arclength_step(path) : MHB_ARCLENGTH_STALLED;
    if (way == MHB_ARCLENGTH_ON && i > 0 && back_at(path, end, inwards)) break;
    budget -= inwards * path->next.tangent[path->n] < 0 && !is_linear(path);
  }
  path->low  = low;
  path->high = high;
  return way == MHB_ARCLENGTH_ON ? MHB_ARCLENGTH_ON : MHB_ARCLENGTH_STALLED;
}

mhb_arclength_outcome mhb_arclength_excursion(mhb_arclength *path, mhb_arclength_outcome outcome) {
  int inwards = outcome == MHB_ARCLENGTH_AT_START ? 1 : -1;
  mhb_arclength_advance(path);
  return excursion(path, inwards, far_room(path, inwards > 0 ? path->low : path->high, inwards),
                   MAX_OUTSIDE);
}

mhb_arclength_outcome mhb_arclength_excursion_within_budget(mhb_arclength        *path,
                                                            mhb_arclength_outcome outcome) {
  int    inwards = outcome == MHB_ARCLENGTH_AT_START ? 1 : -1;
  double longest = path->longest, room = near_room(path, inwards > 0 ? path->low : path->high);
  path->longest             = 2 * longest;
  mhb_arclength_outcome way = excursion(path, inwards, room, PATIENCE);
  path->longest             = longest;
  path->step                = fmin(path->step, longest);
  return way;
}

void mhb_arclength_advance(mhb_arclength *path) {
  mhb_curve_point old = path->now;
  path->now           = path->next;
  path->next          = old;
}
