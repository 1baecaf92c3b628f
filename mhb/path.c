#include "mhb/path.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Settings that did not stall on stiff and on kinked curves. */
static const double FIRST_STEP = .02, LONGEST_STEP = .1, LARGEST_ANGLE = .35, SHORTEST_STEP = 1e-4;
static const double STAGNANT = 1e-8, ROUNDED = 1e-9, NEAR = .3;
static const double KINK_STEP = .02, KINK_RATIO = .7;
static const double OUTSIDE = .2, POLISHED = 1e-2, SMOOTH = 1e-5;
/* Of the value, of the chord: brackets in which a kink is the event; how far from it the point is taken. */
static const double NARROW = 2e-7, NARROW_CHORD = .01, BESIDE = 3e-8;
enum {
  MAX_CORRECTIONS    = 12,
  WANTED_CORRECTIONS = 5,
  MAX_HALVINGS       = 3,
  MAX_POLISHED       = 4,
  LASTING            = 10,
  MAX_OUTSIDE        = 1000,
  MAX_TO_KINK        = 100
};

static int point_create(mhb_path_point *point, int n) {
  point->x       = calloc((size_t)n, sizeof(double));
  point->tangent = calloc((size_t)n + 1, sizeof(double));
  return point->x && point->tangent;
}

static void point_free(mhb_path_point *point) {
  free(point->x);
  free(point->tangent);
}

shb_status mhb_path_create(mhb_residual *residual, double low, double high, mhb_path **out) {
  mhb_path *path = calloc(1, sizeof *path);
  SHB_CHECK(path, SHB_ERR_IO, "out of memory");
  int n           = residual->n;
  path->residual  = residual;
  path->n         = n;
  path->low       = low;
  path->high      = high;
  path->span      = high - low;
  path->least     = mhb_parameter_least(residual->parameter);
  path->longest   = LONGEST_STEP;
  path->tolerance = 1e-10;
  path->chord     = calloc((size_t)n + 1, sizeof(double));
  path->kept      = calloc((size_t)n + 1, sizeof(double));
  for (int i = 0; i < 2; i++) path->bracket[i] = calloc((size_t)n + 1, sizeof(double));
  int ok = path->chord && path->kept && path->bracket[0] && path->bracket[1] &&
           point_create(&path->now, n) && point_create(&path->next, n) &&
           point_create(&path->probe, n) && mhb_newton_create(n, &path->newton) == SHB_OK &&
           mhb_newton_bind(path->newton, residual) == SHB_OK &&
           mhb_still_create(residual, &path->still) == SHB_OK;
  if (!ok) {
    mhb_path_destroy(path);
    SHB_FAIL(SHB_ERR_IO, "out of memory for a path of %d unknowns", n);
  }
  *out = path;
  return SHB_OK;
}

void mhb_path_destroy(mhb_path *path) {
  if (!path) return;
  point_free(&path->now);
  point_free(&path->next);
  point_free(&path->probe);
  mhb_newton_destroy(path->newton);
  mhb_still_destroy(path->still);
  free(path->chord);
  free(path->kept);
  for (int i = 0; i < 2; i++) free(path->bracket[i]);
  free(path);
}

static double span(const mhb_path *path) {
  return path->span;
}

/* What a change of the parameter is compared with. */
static double size_of(const mhb_path *path) {
  double size = fabs(path->now.value);
  return path->residual->parameter == MHB_IN_FREQUENCY ? size : fmax(size, path->span);
}

/* Length unit of x: the size of the current point. */
static double unit(const mhb_path *path) {
  double size = mhb_norm(path->now.x, path->n);
  return size > 0 ? size : 1;
}

/* Inner product of two (dx, dvalue) in y. */
static double inner(const mhb_path *path, double scale, const double *a, const double *b) {
  double sum = a[path->n] * b[path->n] / (span(path) * span(path));
  for (int i = 0; i < path->n; i++) sum += (a[i] / scale) * (b[i] / scale);
  return sum;
}

/* Factor [J, r_value; normal] in scaled columns; 0 if singular. */
static int factor_bordered(const mhb_path *path, double scale, const double *normal) {
  mhb_newton *w  = path->newton;
  int         n  = path->n;
  double      sp = span(path);
  for (int i = 0; i < n; i++) w->row[i] = normal[i] / scale;
  for (int i = 0; i < n; i++) w->trial[i] = w->slope[i] * sp / scale;
  w->row[n] = w->trial[n] = normal[n] / sp;
  return mhb_condensed_factor(w->system, w->trial, w->row);
}

static int solve_bordered(const mhb_path *path, double *rhs) {
  return mhb_condensed_solve(path->newton->system, rhs);
}

static void evaluate(mhb_path *path, const mhb_path_point *point) {
  mhb_newton *w = path->newton;
  mhb_residual_derive(path->residual, point->x, point->value, w->r, w->slope);
}

/* Evaluate, and note the relative residual. */
static void measure(mhb_path *path, mhb_path_point *point) {
  evaluate(path, point);
  double size     = mhb_norm(point->x, path->n);
  point->residual = mhb_norm(path->newton->r, path->n) / (size > 0 ? size : 1);
}

/* point += fraction of the scaled step in the workspace */
static void move(const mhb_path *path, double fraction, double scale, mhb_path_point *point) {
  const double *step = path->newton->step;
  for (int i = 0; i < path->n; i++) point->x[i] += fraction * scale * step[i];
  point->value += fraction * span(path) * step[path->n];
}

/* Evaluate at point; halve the last move (cut) while the residual grows. 0: not finite. */
static int evaluate_damped(mhb_path *path, double before, double cut, double scale,
                           mhb_path_point *point) {
  for (int halvings = 0;; halvings++) {
    measure(path, point);
    if (point->residual <= before || halvings == MAX_HALVINGS) return isfinite(point->residual);
    cut *= .5;
    move(path, -cut, scale, point);
  }
}

/* Near the solution the factors at hand do: the law's derivative costs up to ten times its force. As long as each step gains a
 * decade; what is left is for Newton. The derivatives stay those of the factors. A coarse law has jumps that lead the steps astray. */
static void polish(mhb_path *path, double scale, mhb_path_point *point) {
  mhb_newton *w      = path->newton;
  int         n      = path->n;
  double      before = POLISHED;
  if (path->residual->settings->tolerance > SMOOTH) return;
  for (int i = 0; i < MAX_POLISHED && point->value >= path->least; i++) {
    mhb_residual_evaluate(path->residual, point->x, point->value, w->r, NULL, NULL);
    double residual = mhb_norm(w->r, n) / mhb_norm(point->x, n);
    if (!(residual <= before) || residual <= path->tolerance) return;
    for (int j = 0; j < n; j++) w->step[j] = -w->r[j] / scale;
    w->step[n] = 0;
    if (!solve_bordered(path, w->step)) return;
    move(path, 1, scale, point);
    before = .1 * residual;
  }
}

/* Newton in the plane normal.(y - point at entry) = 0; clip bounds a correction. still: only as long as the pairs stay as noted.
 * 1: converged, workspace at point. */
static int correct_while(mhb_path *path, const double *normal, double clip, int still,
                         mhb_path_point *point) {
  mhb_newton *w     = path->newton;
  int         n     = path->n;
  double      scale = unit(path), before = INFINITY, cut = 0;
  for (point->iterations = 0; point->iterations <= MAX_CORRECTIONS; point->iterations++) {
    if (!evaluate_damped(path, before, cut, scale, point)) return 0;
    if (still && !mhb_still_holds(path->still, path->residual)) return 0;
    if (point->residual <= path->tolerance) return 1;
    if (point->residual < STAGNANT && point->residual > .5 * before) return 1; /* rounding */
    before = point->residual;
    if (point->iterations == MAX_CORRECTIONS || !factor_bordered(path, scale, normal)) return 0;
    for (int i = 0; i < n; i++) w->step[i] = -w->r[i] / scale;
    w->step[n] = 0; /* every iterate stays in the plane */
    if (!solve_bordered(path, w->step)) return 0;
    double length = mhb_norm(w->step, n + 1);
    cut           = length > clip ? clip / length : 1;
    move(path, cut, scale, point);
    if (cut == 1 && before < POLISHED) polish(path, scale, point);
    if (!(point->value >= path->least)) return 0;
  }
  return 0;
}

static int correct(mhb_path *path, const double *normal, double clip, mhb_path_point *point) {
  return correct_while(path, normal, clip, 0, point);
}

/* Tangent at a point the workspace is at: [J r_value; along] t = [0; 1], scaled to unit length. */
static int set_tangent(mhb_path *path, const double *along, mhb_path_point *point) {
  mhb_newton *w     = path->newton;
  int         n     = path->n;
  double      scale = unit(path);
  if (!factor_bordered(path, scale, along)) return 0;
  memset(w->step, 0, sizeof(double) * ((size_t)n + 1));
  w->step[n] = 1;
  if (!solve_bordered(path, w->step)) return 0;
  double length = mhb_norm(w->step, n + 1);
  if (!(length > 0) || !isfinite(length)) return 0;
  for (int i = 0; i < n; i++) point->tangent[i] = w->step[i] / length * scale;
  point->tangent[n]  = w->step[n] / length * span(path);
  point->orientation = mhb_condensed_sign(w->system);
  return 1;
}

mhb_reason mhb_path_start(mhb_path *path, const double *x, double value, int direction) {
  memcpy(path->now.x, x, sizeof(double) * (size_t)path->n);
  path->now.value   = value;
  path->step        = FIRST_STEP;
  mhb_reason reason = mhb_newton_solve(path->newton, path->residual, value, path->tolerance,
                                       path->now.x, &path->now.iterations);
  if (reason != MHB_CONVERGED) return reason;
  measure(path, &path->now);
  double *along = path->chord;
  memset(along, 0, sizeof(double) * (size_t)path->n);
  along[path->n] = direction * span(path);
  if (!set_tangent(path, along, &path->now)) return MHB_SINGULAR;
  path->orientation = path->now.orientation;
  path->against     = 0;
  return MHB_CONVERGED;
}

static void predict(mhb_path *path, double ds) {
  for (int i = 0; i < path->n; i++) path->next.x[i] = path->now.x[i] + ds * path->now.tangent[i];
  path->next.value = path->now.value + ds * path->now.tangent[path->n];
}

/* Where no pair moves, as noted, all but the means is found without the law, which only says whether that holds. */
static int correct_still(mhb_path *path, const double *normal, double clip, mhb_path_point *point) {
  double scale = unit(path), sp = span(path);
  int    steps;
  if (!mhb_still_slide(path->still, path->residual, normal, 1 / (scale * scale), 1 / (sp * sp),
                       point->x, &point->value, &steps) ||
      !correct_while(path, normal, clip, 1, point))
    return 0;
  if (point->iterations < steps - 1) point->iterations = steps - 1;
  return 1;
}

/* next <- now + ds tangent, corrected. */
static int attempt(mhb_path *path, double ds) {
  predict(path, ds);
  int ok = mhb_still_note(path->still, path->residual) &&
           correct_still(path, path->now.tangent, 2 * ds, &path->next);
  if (!ok) predict(path, ds);
  return (ok || correct(path, path->now.tangent, 2 * ds, &path->next)) &&
         set_tangent(path, path->now.tangent, &path->next);
}

static double angle_between(const mhb_path *path) {
  double scale = unit(path), *a = path->now.tangent, *b = path->next.tangent;
  double length = sqrt(inner(path, scale, a, a) * inner(path, scale, b, b));
  double cosine = inner(path, scale, a, b) / length;
  return acos(fmax(-1, fmin(1, cosine)));
}

/* next <- a solution at fixed value, Newton damped, from a guess that may be far; kept if it is near now. */
static int attempt_from(mhb_path *path, double value, const double *guess) {
  mhb_path_point *next = &path->next;
  size_t          size = sizeof(double) * (size_t)path->n;
  memcpy(next->x, guess, size);
  next->value = value;
  if (mhb_newton_solve(path->newton, path->residual, value, path->tolerance, next->x,
                       &next->iterations) != MHB_CONVERGED)
    return 0;
  measure(path, next);
  double scale = unit(path), far = 0;
  for (int i = 0; i < path->n; i++) far = fmax(far, fabs(next->x[i] - path->now.x[i]) / scale);
  memset(path->chord, 0, size); /* onwards in frequency */
  path->chord[path->n] = value - path->now.value;
  return far < NEAR && set_tangent(path, path->chord, next);
}

mhb_reason mhb_path_depart(mhb_path *path, const double *x, double value, const double *along) {
  static const double step[] = {1e-2, 3e-2, 3e-3, 1e-3};
  mhb_path_point     *now    = &path->now;
  memcpy(now->x, x, sizeof(double) * (size_t)path->n);
  now->value   = value;
  double scale = unit(path), length = mhb_norm(along, path->n) / scale;
  for (int i = 0; i < path->n; i++) now->tangent[i] = along[i] / length;
  now->tangent[path->n] = 0;
  for (int i = 0; i < 4; i++) {
    if (!attempt(path, step[i])) continue;
    double gone = inner(path, scale, now->tangent, path->next.tangent);
    if (gone < .5) continue; /* along the curve that is left */
    path->step        = step[i];
    path->orientation = path->next.orientation;
    path->against     = 0;
    mhb_path_advance(path);
    return MHB_CONVERGED;
  }
  return MHB_NO_DESCENT;
}

/* The path goes on through next, rather than back along what was passed. */
static int goes_on(const mhb_path *path) {
  return path->next.orientation == path->orientation;
}

/* A bifurcation turns the orientation for good; the square-root zone of slip onset for a few points only. */
static void note_orientation(mhb_path *path) {
  path->against = path->next.orientation == path->orientation ? 0 : path->against + 1;
  if (path->against < LASTING) return;
  path->orientation = path->next.orientation;
  path->against     = 0;
}

/* Past a kink the path may leave in any direction, even back in frequency. Its tangent is that of the law at a place ahead,
 * taken in the sense that keeps the orientation, as in the continuation of piecewise linear maps. */
static int attempt_across(mhb_path *path, double ahead, double ds) {
  mhb_path_point *now = &path->now, *next = &path->next;
  int             one = path->n + 1;
  for (int i = 0; i < path->n; i++) next->x[i] = now->x[i] + ahead * now->tangent[i];
  next->value = now->value + ahead * now->tangent[path->n];
  evaluate(path, next);
  if (!set_tangent(path, now->tangent, next)) return 0;
  double sense = goes_on(path) ? 1 : -1;
  for (int i = 0; i < one; i++) path->chord[i] = sense * next->tangent[i];
  for (int i = 0; i < path->n; i++) next->x[i] = now->x[i] + ds * path->chord[i];
  next->value = now->value + ds * path->chord[path->n];
  return correct(path, path->chord, 2 * ds, next) && set_tangent(path, path->chord, next) &&
         goes_on(path);
}

static int across_kink(mhb_path *path) {
  static const double ahead[] = {1e-4, 1e-3, 1e-2}, step[] = {1e-3, 3e-3, 1e-2, 3e-4, 1e-4};
  for (int i = 0; i < 15; i++) {
    if (!attempt_across(path, ahead[i % 3], step[i / 3])) continue;
    path->step = step[i / 3];
    return 1;
  }
  return 0;
}

/* Where small steps fail (the square-root zone at slip onset), larger ones pass; else the damped Newton at a fixed
 * value further on, then further back (a cusp), from the old point and from the linear limits. */
static int last_resort(mhb_path *path) {
  const double larger[] = {3e-3, 1e-2, 3e-2, .1}, further[] = {1e-4, 5e-4, 2e-3, 1e-2};
  for (int i = 0; i < 4; i++) {
    if (!attempt(path, larger[i]) || !goes_on(path)) continue;
    path->step = larger[i];
    return 1;
  }
  double guess[path->n], forward = copysign(span(path), path->now.tangent[path->n]);
  for (int i = 0; i < 24; i++) {
    double value = path->now.value + (i < 12 ? forward : -forward) * further[i / 3 % 4];
    int    stuck = i % 3 - 1; /* -1: the old point */
    if (value < path->low || value > path->high) continue;
    if (stuck < 0) {
      memcpy(guess, path->now.x, sizeof guess);
    } else if (mhb_residual_linear(path->residual, value, stuck, guess) != SHB_OK) {
      continue;
    }
    if (!attempt_from(path, value, guess) || !goes_on(path)) continue;
    path->step = FIRST_STEP;
    return 1;
  }
  return 0;
}

/* Nothing keeps the orientation: a bifurcation, or the zone of slip onset where it cannot be trusted. */
static int turned(mhb_path *path) {
  static const double step[] = {1e-3, 3e-3, 1e-2, 3e-4};
  for (int i = 0; i < 4; i++) {
    if (!attempt(path, step[i]) || angle_between(path) > LARGEST_ANGLE) continue;
    path->step = step[i];
    note_orientation(path);
    return 1;
  }
  return 0;
}

static int find_next(mhb_path *path) {
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

/* next went past an end of the range: solve on the end itself, from the chord. */
static int settle_on(mhb_path *path, double value) {
  double part = (value - path->now.value) / (path->next.value - path->now.value);
  double axis[path->n + 1];
  memset(axis, 0, sizeof(double) * (size_t)path->n);
  axis[path->n] = span(path);
  for (int i = 0; i < path->n; i++)
    path->next.x[i] = path->now.x[i] + part * (path->next.x[i] - path->now.x[i]);
  path->next.value = value;
  int ok =
      correct(path, axis, .5, &path->next) && set_tangent(path, path->now.tangent, &path->next);
  path->next.value = value;
  return ok;
}

mhb_path_outcome mhb_path_step(mhb_path *path) {
  for (int tries = 0; tries < 4; tries++) {
    if (!find_next(path)) break;
    double slack = 1e-12 * fmax(fabs(path->low), fabs(path->high));
    int above = path->next.value > path->high + slack, below = path->next.value < path->low - slack;
    if (!above && !below) return MHB_PATH_ON;
    if (settle_on(path, above ? path->high : path->low))
      return above ? MHB_PATH_AT_END : MHB_PATH_AT_START;
    path->step = fmax(SHORTEST_STEP, .2 * path->step);
  }
  return MHB_PATH_STALLED;
}

/* next has come back to the end of the range: set it on the end, heading inwards. */
static int back_at(mhb_path *path, double end, int inwards) {
  if (inwards * (path->next.value - end) < 0) return 0;
  return settle_on(path, end) && inwards * path->next.tangent[path->n] > 0;
}

/* Room beyond the end that the path has come to: frequencies by a factor, other parameters by some spans. */
static void widen(mhb_path *path, int inwards) {
  int    turns = path->residual->parameter == MHB_IN_FREQUENCY;
  double room  = (1 / OUTSIDE - 1) * path->span;
  if (inwards > 0)
    path->low = turns ? OUTSIDE * path->low : fmax(path->least, path->low - room);
  else
    path->high = turns ? path->high / OUTSIDE : path->high + room;
}

mhb_path_outcome mhb_path_outside(mhb_path *path, mhb_path_outcome outcome) {
  double           low = path->low, high = path->high;
  int              inwards = outcome == MHB_PATH_AT_START ? 1 : -1;
  mhb_path_outcome way     = MHB_PATH_ON;
  widen(path, inwards);
  for (int i = 0; i < MAX_OUTSIDE && way == MHB_PATH_ON; i++) {
    mhb_path_advance(path);
    way = mhb_path_step(path);
    if (way == MHB_PATH_ON && back_at(path, inwards > 0 ? low : high, inwards)) break;
    if (i == MAX_OUTSIDE - 1) way = MHB_PATH_STALLED;
  }
  path->low  = low;
  path->high = high;
  return way == MHB_PATH_ON ? MHB_PATH_ON : MHB_PATH_STALLED;
}

void mhb_path_advance(mhb_path *path) {
  mhb_path_point old = path->now;
  path->now          = path->next;
  path->next         = old;
}

/* Which guess at fraction s, between the solved ends lo and hi of a bracket: the line between them, or one end, shifted. */
static void guess_at(const mhb_path *path, double s, double lo, double hi, int which,
                     mhb_path_point *probe) {
  const double *a = path->bracket[0], *b = path->bracket[1];
  double        part = which == 0 ? (s - lo) / (hi - lo) : which - 1;
  double        rest = which == 0 ? 0 : which == 1 ? s - lo : s - hi;
  for (int i = 0; i <= path->n; i++) {
    double y = a[i] + part * (b[i] - a[i]) + rest * path->chord[i];
    if (i < path->n)
      probe->x[i] = y;
    else
      probe->value = y;
  }
}

/* probe <- what a guess converges to; 0 if it does not. The fourth is the first one by the damped Newton. */
static int from_guess(mhb_path *path, double s, double lo, double hi, int which) {
  mhb_path_point *probe = &path->probe;
  guess_at(path, s, lo, hi, which % 3, probe);
  if (which < 3) return correct(path, path->chord, 1, probe);
  if (mhb_newton_solve(path->newton, path->residual, probe->value, path->tolerance, probe->x,
                       &probe->iterations) != MHB_CONVERGED)
    return 0;
  measure(path, probe);
  return 1;
}

/* probe <- the solution in the plane across the chord at fraction s. In the square-root zone of slip onset the plane's
 * Newton can fail; the damped one at fixed frequency then stands in. What rounding stopped is taken if nothing is better. */
static int at_fraction(mhb_path *path, double s, double lo, double hi) {
  int rounded = -1;
  for (int which = 0; which < 4; which++) {
    if (!from_guess(path, s, lo, hi, which)) continue;
    if (path->probe.residual <= path->tolerance && set_tangent(path, path->chord, &path->probe))
      return 1;
    if (path->probe.residual <= ROUNDED && rounded < 0) rounded = which;
  }
  return rounded >= 0 && from_guess(path, s, lo, hi, rounded) &&
         set_tangent(path, path->chord, &path->probe);
}

/* probe <- an end of the bracket as it was found: Newton need not come back to it. */
static int at_end(mhb_path *path, int side) {
  mhb_path_point *probe = &path->probe;
  memcpy(probe->x, path->bracket[side], sizeof(double) * (size_t)path->n);
  probe->value = path->bracket[side][path->n];
  measure(path, probe);
  return set_tangent(path, path->chord, probe);
}

/* Somewhere else in the bracket, then at *s. */
static int somewhere(mhb_path *path, double lo, double hi, double *s) {
  static const double other[] = {.5, .2, .8, .05, .95};
  for (int i = 0; i < 5; i++) {
    *s = lo + other[i] * (hi - lo);
    if (at_fraction(path, *s, lo, hi)) return 1;
  }
  return 0;
}

static void set_bracket(mhb_path *path, int side, const mhb_path_point *point) {
  memcpy(path->bracket[side], point->x, sizeof(double) * (size_t)path->n);
  path->bracket[side][path->n] = point->value;
}

/* The bracket being narrowed: fractions of the chord and the indicator at its ends; the chord's part of the value. */
typedef struct {
  double at[2], f[2], wide;
} range;

static int is_narrow(const range *r) {
  double length = r->at[1] - r->at[0];
  return length < NARROW_CHORD && length * r->wide < NARROW;
}

/* No pair slips or opens for a part of the period: the law is exact there. */
static int is_still(const mhb_residual *b) {
  for (int a = 0; a < b->n_pairs; a++)
    if (b->kind[a] == MHB_PAIR_MOVING) return 0;
  return 1;
}

/* The side of the bracket that is still, if the other is not; else -1. */
static int still_side(mhb_path *path) {
  int still[2];
  for (int side = 0; side < 2; side++) still[side] = at_end(path, side) && is_still(path->residual);
  return still[0] == still[1] ? -1 : still[1];
}

/* probe <- a point in the plane at the chord's fraction s, along the tangent of the probe as it was at an end. */
static void along_tangent(mhb_path *path, int side, double ahead) {
  mhb_path_point *probe = &path->probe;
  double scale = unit(path), length = inner(path, scale, path->chord, path->chord) * ahead /
                                      inner(path, scale, path->chord, probe->tangent);
  for (int i = 0; i < path->n; i++)
    probe->x[i] = path->bracket[side][i] + length * probe->tangent[i];
  probe->value = path->bracket[side][path->n] + length * probe->tangent[path->n];
}

/* Where contacts begin to slip, that side is known to the root of rounding only and Newton may fail, the still side is exact: its
 * last point, in steps that are halved, becomes that end of the bracket (the old one is kept) and the probe. */
static int go_to_kink(mhb_path *path, int side, range *r) {
  double step = .5 * (r->at[1 - side] - r->at[side]);
  memcpy(path->kept, path->bracket[side], sizeof(double) * ((size_t)path->n + 1));
  if (!at_end(path, side) || !mhb_still_note(path->still, path->residual)) return 0;
  for (int i = 0; i < MAX_TO_KINK && fabs(step) > 1e-9; i++) {
    double s = r->at[side] + step;
    along_tangent(path, side, step);
    if (s > r->at[0] && s < r->at[1] && correct_still(path, path->chord, 1, &path->probe) &&
        set_tangent(path, path->chord, &path->probe)) {
      r->at[side] = s;
      set_bracket(path, side, &path->probe);
    } else {
      step *= .5;
    }
  }
  return at_end(path, side);
}

static void swap(double **a, double **b) {
  double *old = *a;
  *a          = *b;
  *b          = old;
}

/* probe <- a point on the still side of the kink that the probe is at: so near that it does not matter, so far that Newton comes
 * back to it. */
static int beside_kink(mhb_path *path, int side, double before, range *r) {
  double way = before - r->at[side], most = BESIDE / fmax(r->wide, BESIDE);
  double back = copysign(fmin(most, .5 * fabs(way)), way);
  along_tangent(path, side, back);
  if (!correct_still(path, path->chord, 1, &path->probe) ||
      !set_tangent(path, path->chord, &path->probe))
    return at_end(path, side);
  r->at[side] += back;
  return 1;
}

/* 1: a kink, and the probe beside it, is the event. Else the bracket ends there, if it holds one. */
static int at_kink(mhb_path *path, mhb_path_indicator indicator, void *context, range *r) {
  int side = still_side(path);
  if (side < 0) return 0;
  double before = r->at[side];
  if (!go_to_kink(path, side, r)) return 0;
  double f = indicator(path, &path->probe, context);
  if ((f > 0) == (r->f[side] > 0)) {
    r->f[side] = f;
    return is_narrow(r) && beside_kink(path, side, before, r);
  }
  swap(&path->bracket[1 - side], &path->bracket[side]); /* the event is on the still side */
  swap(&path->bracket[side], &path->kept);
  r->at[1 - side] = r->at[side];
  r->f[1 - side]  = f;
  r->at[side]     = before;
  return 0;
}

int mhb_path_locate(mhb_path *path, mhb_path_indicator indicator, void *context, double at_now,
                    double at_next, double *fraction) {
  for (int i = 0; i < path->n; i++) path->chord[i] = path->next.x[i] - path->now.x[i];
  path->chord[path->n] = path->next.value - path->now.value;
  range r              = {
                   .at = {0, 1}, .f = {at_now, at_next}, .wide = fabs(path->chord[path->n]) / size_of(path)};
  int last = -1, kinks = 0;
  set_bracket(path, 0, &path->now);
  set_bracket(path, 1, &path->next);
  for (int i = 0; i < 40; i++) {
    double s = (r.at[0] * r.f[1] - r.at[1] * r.f[0]) / (r.f[1] - r.f[0]);
    if (i % 4 == 3 || !(s > r.at[0] && s < r.at[1])) s = .5 * (r.at[0] + r.at[1]);
    int ok = (kinks > 0 || !is_narrow(&r)) && at_fraction(path, s, r.at[0], r.at[1]);
    if (!ok && kinks++ == 0) {
      *fraction = s;
      if (at_kink(path, indicator, context, &r)) return 1;
      continue;
    }
    if (!ok && (is_narrow(&r) || !somewhere(path, r.at[0], r.at[1], &s))) {
      *fraction = r.at[0]; /* as near as can be had */
      return i > 2 && (r.at[1] - r.at[0]) * r.wide < 1e-4 && at_end(path, 0);
    }
    double f  = indicator(path, &path->probe, context);
    *fraction = s;
    if (f == 0) return 1;
    int side = (f > 0) != (r.f[0] > 0);
    set_bracket(path, side, &path->probe);
    double moved = fabs(s - r.at[side]);
    r.at[side]   = s;
    r.f[side]    = f;
    if (side == last) r.f[1 - side] *= .5;
    last        = side;
    double left = fmin(r.at[1] - r.at[0], moved);
    if (left < 1e-9 || (i > 2 && left * r.wide < 1e-10 && left < 1e-4)) return 1;
  }
  return 1;
}
