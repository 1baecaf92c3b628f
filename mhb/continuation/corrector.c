#include "mhb/continuation/corrector.h"

#include <math.h>
#include <string.h>

static const double POLISHED = 1e-2, SMOOTH = 1e-5;
enum { MAX_CORRECTIONS = 12, MAX_HALVINGS = 3, MAX_POLISHED = 4, MAX_SETTLED = 6 };

double mhb_arclength_size(const mhb_arclength *path) {
  double size = fabs(path->now.value);
  return path->residual->parameter == MHB_IN_FREQUENCY ? size : fmax(size, path->span);
}

double mhb_arclength_unit(const mhb_arclength *path) {
  double size = mhb_norm(path->now.x, path->n);
  return size > 0 ? size : path->rest;
}

double mhb_arclength_inner(const mhb_arclength *path, double scale, const double *a,
                           const double *b) {
  double sum = a[path->n] * b[path->n] / (path->span * path->span);
  for (int i = 0; i < path->n; i++) sum += (a[i] / scale) * (b[i] / scale);
  return sum;
}

/* Factor [J, r_value; normal] in scaled columns; 0 if singular. */
static int factor_bordered(const mhb_arclength *path, double scale, const double *normal) {
  mhb_newton *w  = path->newton;
  int         n  = path->n;
  double      sp = path->span;
  for (int i = 0; i < n; i++) w->row[i] = normal[i] / scale;
  for (int i = 0; i < n; i++) w->trial[i] = w->slope[i] * sp / scale;
  w->row[n] = w->trial[n] = normal[n] / sp;
  return mhb_condensation_factor(w->system, w->trial, w->row);
}

static int solve_bordered(const mhb_arclength *path, double *rhs) {
  return mhb_condensation_solve(path->newton->system, rhs);
}

void mhb_arclength_evaluate(mhb_arclength *path, const mhb_curve_point *point) {
  mhb_newton *w = path->newton;
  mhb_balance_linearise(path->residual, point->x, point->value, w->r, w->slope);
}

void mhb_arclength_measure(mhb_arclength *path, mhb_curve_point *point) {
  mhb_arclength_evaluate(path, point);
  double size     = mhb_norm(point->x, path->n);
  point->residual = mhb_norm(path->newton->r, path->n) / (size > 0 ? size : path->rest);
}

/* point += fraction of the scaled step in the workspace */
static void move(const mhb_arclength *path, double fraction, double scale, mhb_curve_point *point) {
  const double *step = path->newton->step;
  for (int i = 0; i < path->n; i++) point->x[i] += fraction * scale * step[i];
  point->value += fraction * path->span * step[path->n];
}

/* Evaluate at point; halve the last move (cut) while the residual grows. 0: not finite. */
static int evaluate_damped(mhb_arclength *path, double before, double cut, double scale,
                           mhb_curve_point *point) {
  for (int halvings = 0;; halvings++) {
    mhb_arclength_measure(path, point);
    if (point->residual <= before || halvings == MAX_HALVINGS) return isfinite(point->residual);
    cut *= .5;
    move(path, -cut, scale, point);
  }
}

/* Near the solution the factors at hand do: the law's derivative costs up to ten times its force. As long as each step gains a
 * decade; what is left is for Newton. The derivatives stay those of the factors. A coarse law has jumps that lead the steps astray. */
static void polish(mhb_arclength *path, double scale, mhb_curve_point *point) {
  mhb_newton *w      = path->newton;
  int         n      = path->n;
  double      before = POLISHED;
  if (path->residual->settings->tolerance > SMOOTH) return;
  for (int i = 0; i < MAX_POLISHED && point->value >= path->least; i++) {
    mhb_balance_evaluate(path->residual, point->x, point->value, w->r, NULL, NULL);
    double residual = mhb_norm(w->r, n) / mhb_norm(point->x, n);
    if (!(residual <= before) || residual <= path->tolerance) return;
    for (int j = 0; j < n; j++) w->step[j] = -w->r[j] / scale;
    w->step[n] = 0;
    if (!solve_bordered(path, w->step)) return;
    move(path, 1, scale, point);
    before = .1 * residual;
  }
}

/* Between two faces of a kink Newton goes to and fro for ever: the last two residuals are those of two iterations before. */
static int goes_in_circles(const double *seen, int last) {
  for (int i = last; i > last - 2; i--)
    if (i < 2 || fabs(seen[i] - seen[i - 2]) > 1e-3 * seen[i]) return 0;
  return 1;
}

int mhb_arclength_correct(mhb_arclength *path, const double *normal, double clip,
                          mhb_curve_point *point) {
  mhb_newton *w     = path->newton;
  int         n     = path->n;
  double      scale = mhb_arclength_unit(path), before = INFINITY, cut = 0;
  double      seen[MAX_CORRECTIONS + 1];
  for (point->iterations = 0; point->iterations <= MAX_CORRECTIONS; point->iterations++) {
    if (!evaluate_damped(path, before, cut, scale, point)) return 0;
    if (point->residual <= path->tolerance) return 1;
    if (point->residual < path->stagnant && point->residual > .5 * before) return 1; /* rounding */
    before = seen[point->iterations] = point->residual;
    if (goes_in_circles(seen, point->iterations)) return 0;
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

/* Tangent at a point the workspace is at: [J r_value; along] t = [0; 1], scaled to unit length. */
int mhb_arclength_set_tangent(mhb_arclength *path, const double *along, mhb_curve_point *point) {
  mhb_newton *w     = path->newton;
  int         n     = path->n;
  double      scale = mhb_arclength_unit(path);
  if (!factor_bordered(path, scale, along)) return 0;
  memset(w->step, 0, sizeof(double) * ((size_t)n + 1));
  w->step[n] = 1;
  if (!solve_bordered(path, w->step)) return 0;
  double length = mhb_norm(w->step, n + 1);
  if (!(length > 0) || !isfinite(length)) return 0;
  for (int i = 0; i < n; i++) point->tangent[i] = w->step[i] / length * scale;
  point->tangent[n]  = w->step[n] / length * path->span;
  point->orientation = mhb_condensation_sign(w->system);
  return 1;
}

/* Means that balance, as long as the pairs stay as noted: the means leave the plane by a hair, which does not matter. */
static int settle(mhb_arclength *path, mhb_curve_point *point) {
  double before = INFINITY;
  for (int i = 0; i <= MAX_SETTLED; i++) {
    point->iterations = i;
    mhb_arclength_measure(path, point);
    if (!mhb_linear_states_hold(path->still, path->residual)) return 0;
    if (point->residual <= path->tolerance) return 1;
    if (point->residual < path->stagnant && point->residual > .5 * before) return 1; /* rounding */
    if (!(point->residual < .5 * before)) return 0;
    if (!mhb_linear_correct_means(path->still, path->residual, path->newton->r, i > 0, point->x))
      return 0;
    before = point->residual;
  }
  return 0;
}

int mhb_arclength_correct_still(mhb_arclength *path, const double *normal, mhb_curve_point *point) {
  double scale = mhb_arclength_unit(path), sp = path->span;
  int    steps;
  if (!mhb_linear_correct(path->still, path->residual, normal, 1 / (scale * scale), 1 / (sp * sp),
                          point->x, &point->value, &steps) ||
      !settle(path, point))
    return 0;
  if (point->iterations < steps - 1) point->iterations = steps - 1;
  return 1;
}
