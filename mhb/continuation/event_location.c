#include "mhb/continuation/event_location.h"

#include <math.h>
#include <string.h>

#include "mhb/continuation/corrector.h"

static const double ROUNDED = 1e-9;

/* Of the value, of the chord: brackets in which a kink is the event; how far from it the point is taken. */
static const double NARROW = 2e-7, NARROW_CHORD = .01, BESIDE = 3e-8;
enum { MAX_TO_KINK = 100, GUESSES = 4 };

/* An indicator that jumps leads Illinois astray: from HALVED on the bracket is halved. */
enum { HALVED = 24, MAX_STEPS = 64 };

/* The bracket being narrowed: fractions of the chord and the indicator at its ends; the chord's part of the value; which guess
 * was good last. */
typedef struct {
  double at[2], f[2], wide;
  int    guess;
} range;

/* Which guess at fraction s, between the solved ends lo and hi of a bracket: the line between them, or one end, shifted. */
static void guess_at(const mhb_arclength *path, double s, double lo, double hi, int which,
                     mhb_curve_point *probe) {
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
static int from_guess(mhb_arclength *path, double s, double lo, double hi, int which) {
  mhb_curve_point *probe = &path->probe;
  guess_at(path, s, lo, hi, which % 3, probe);
  if (which < 3) return mhb_arclength_correct(path, path->chord, 1, probe);
  if (mhb_newton_solve(path->newton, path->residual, probe->value, path->tolerance, probe->x,
                       &probe->iterations) != MHB_CONVERGED)
    return 0;
  mhb_arclength_measure(path, probe);
  return 1;
}

/* Which fraction of the chord the probe is at; a solution at fixed value need not be in the plane it was sought in. */
static double fraction_of(mhb_arclength *path) {
  double scale = mhb_arclength_unit(path), away[path->n + 1];
  for (int i = 0; i < path->n; i++) away[i] = path->probe.x[i] - path->now.x[i];
  away[path->n] = path->probe.value - path->now.value;
  return mhb_arclength_inner(path, scale, path->chord, away) /
         mhb_arclength_inner(path, scale, path->chord, path->chord);
}

/* probe <- the solution in the plane across the chord at fraction *s. In the square-root zone of slip onset the plane's
 * Newton can fail; the damped one at fixed frequency then stands in, if it stays in the bracket, and is tried first from there on.
 * What rounding stopped is taken if nothing is better. */
static int at_fraction(mhb_arclength *path, range *r, double *s) {
  int rounded = -1;
  for (int i = 0; i < GUESSES; i++) {
    int which = (r->guess + i) % GUESSES;
    if (!from_guess(path, *s, r->at[0], r->at[1], which)) continue;
    double at = which < 3 ? *s : fraction_of(path);
    if (!(at > r->at[0] && at < r->at[1])) continue;
    if (path->probe.residual <= path->tolerance &&
        mhb_arclength_set_tangent(path, path->chord, &path->probe)) {
      r->guess = which;
      *s       = at;
      return 1;
    }
    if (path->probe.residual <= ROUNDED && rounded < 0) rounded = which;
  }
  return rounded >= 0 && from_guess(path, *s, r->at[0], r->at[1], rounded) &&
         mhb_arclength_set_tangent(path, path->chord, &path->probe);
}

/* probe <- an end of the bracket as it was found: Newton need not come back to it. */
static int at_end(mhb_arclength *path, int side) {
  mhb_curve_point *probe = &path->probe;
  memcpy(probe->x, path->bracket[side], sizeof(double) * (size_t)path->n);
  probe->value = path->bracket[side][path->n];
  mhb_arclength_measure(path, probe);
  return mhb_arclength_set_tangent(path, path->chord, probe);
}

/* Somewhere else in the bracket, then at *s. */
static int somewhere(mhb_arclength *path, range *r, double *s) {
  static const double other[] = {.5, .2, .8, .05, .95};
  for (int i = 0; i < 5; i++) {
    *s = r->at[0] + other[i] * (r->at[1] - r->at[0]);
    if (at_fraction(path, r, s)) return 1;
  }
  return 0;
}

static void set_bracket(mhb_arclength *path, int side, const mhb_curve_point *point) {
  memcpy(path->bracket[side], point->x, sizeof(double) * (size_t)path->n);
  path->bracket[side][path->n] = point->value;
}

static int is_narrow(const range *r) {
  double length = r->at[1] - r->at[0];
  return length < NARROW_CHORD && length * r->wide < NARROW;
}

/* No pair slips or opens for a part of the period: the law is exact there. */
static int is_still(const mhb_balance *b) {
  for (int a = 0; a < b->n_pairs; a++)
    if (b->eval->kind[a] == MHB_PAIR_NONLINEAR) return 0;
  return 1;
}

/* The side of the bracket that is still, if the other is not; else -1. */
static int still_side(mhb_arclength *path) {
  int still[2];
  for (int side = 0; side < 2; side++) still[side] = at_end(path, side) && is_still(path->residual);
  return still[0] == still[1] ? -1 : still[1];
}

/* probe <- a point in the plane at the chord's fraction s, along the tangent of the probe as it was at an end. */
static void along_tangent(mhb_arclength *path, int side, double ahead) {
  mhb_curve_point *probe = &path->probe;
  double           scale = mhb_arclength_unit(path),
         length          = mhb_arclength_inner(path, scale, path->chord, path->chord) * ahead /
                  mhb_arclength_inner(path, scale, path->chord, probe->tangent);
  for (int i = 0; i < path->n; i++)
    probe->x[i] = path->bracket[side][i] + length * probe->tangent[i];
  probe->value = path->bracket[side][path->n] + length * probe->tangent[path->n];
}

/* Where contacts begin to slip, that side is known to the root of rounding only and Newton may fail, the still side is exact: its
 * last point, in steps that are halved, becomes that end of the bracket (the old one is kept) and the probe. */
static int go_to_kink(mhb_arclength *path, int side, range *r) {
  double step = .5 * (r->at[1 - side] - r->at[side]);
  memcpy(path->kept, path->bracket[side], sizeof(double) * ((size_t)path->n + 1));
  if (!at_end(path, side) || !mhb_linear_set_states(path->still, path->residual)) return 0;
  for (int i = 0; i < MAX_TO_KINK && fabs(step) > 1e-9; i++) {
    double s = r->at[side] + step;
    along_tangent(path, side, step);
    if (s > r->at[0] && s < r->at[1] &&
        mhb_arclength_correct_still(path, path->chord, &path->probe) &&
        mhb_arclength_set_tangent(path, path->chord, &path->probe)) {
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
static int beside_kink(mhb_arclength *path, int side, double before, range *r) {
  double way = before - r->at[side], most = BESIDE / fmax(r->wide, BESIDE);
  double back = copysign(fmin(most, .5 * fabs(way)), way);
  along_tangent(path, side, back);
  if (!mhb_arclength_correct_still(path, path->chord, &path->probe) ||
      !mhb_arclength_set_tangent(path, path->chord, &path->probe))
    return at_end(path, side);
  r->at[side] += back;
  return 1;
}

/* 1: a kink, and the probe beside it, is the event. Else the bracket ends there, if it holds one. */
static int at_kink(mhb_arclength *path, mhb_arclength_indicator indicator, void *context,
                   range *r) {
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

int mhb_arclength_locate(mhb_arclength *path, mhb_arclength_indicator indicator, void *context,
                         double at_now, double at_next, double *fraction) {
  for (int i = 0; i < path->n; i++) path->chord[i] = path->next.x[i] - path->now.x[i];
  path->chord[path->n] = path->next.value - path->now.value;
  range r              = {.at   = {0, 1},
                          .f    = {at_now, at_next},
                          .wide = fabs(path->chord[path->n]) / mhb_arclength_size(path)};
  int   last = -1, kinks = 0;
  set_bracket(path, 0, &path->now);
  set_bracket(path, 1, &path->next);
  for (int i = 0; i < MAX_STEPS; i++) {
    double s = (r.at[0] * r.f[1] - r.at[1] * r.f[0]) / (r.f[1] - r.f[0]);
    if (i % 4 == 3 || i >= HALVED || !(s > r.at[0] && s < r.at[1])) s = .5 * (r.at[0] + r.at[1]);
    int ok = (kinks > 0 || !is_narrow(&r)) && at_fraction(path, &r, &s);
    if (!ok && kinks++ == 0) {
      *fraction = s;
      if (at_kink(path, indicator, context, &r)) return 1;
      continue;
    }
    if (!ok && (is_narrow(&r) || !somewhere(path, &r, &s))) {
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
  return 0;
}
