#include "mhb/continuation/nearest_solution.h"

#include <math.h>
#include <string.h>

static const double ROUNDING = 1e-8, FARTHEST = 0.5;
enum { MAX_ITERATIONS = 20, MAX_HALVINGS = 4 };

typedef struct {
  mhb_newton  *newton;
  mhb_balance *balance;
  double       scale, span;
} plane;

/* |r|/|x| at a point. */
static double measure(const plane *p, const double *x, double omega) {
  int n = p->balance->n;
  mhb_balance_linearise(p->balance, x, omega, p->newton->r, p->newton->slope);
  double size = mhb_norm(x, n);
  return mhb_norm(p->newton->r, n) / (size > 0 ? size : 1);
}

/* The scaled step into newton->step: [J r_omega; normal] step = [-r; 0]. */
static int find_step(const plane *p, const double *normal) {
  mhb_newton *w = p->newton;
  int         n = p->balance->n;
  for (int i = 0; i < n; i++) {
    w->row[i]   = normal[i] / p->scale;
    w->trial[i] = w->slope[i] * p->span / p->scale;
    w->step[i]  = -w->r[i] / p->scale;
  }
  w->row[n] = w->trial[n] = normal[n] / p->span;
  w->step[n]              = 0; /* every iterate stays in the plane */
  return mhb_condensation_factor(w->system, w->trial, w->row) &&
         mhb_condensation_solve(w->system, w->step);
}

static void move(const plane *p, double fraction, double *x, double *omega) {
  const double *step = p->newton->step;
  int           n    = p->balance->n;
  for (int i = 0; i < n; i++) x[i] += fraction * p->scale * step[i];
  *omega += fraction * p->span * step[n];
}

int mhb_nearest_solution(mhb_newton *newton, mhb_balance *balance, const double *normal,
                         double scale, double span, double tolerance, double *x, double *omega) {
  plane  p   = {newton, balance, scale, span};
  double way = 0;
  mhb_newton_bind(newton, balance);
  double now = measure(&p, x, *omega);
  for (int i = 0; i < MAX_ITERATIONS && isfinite(now); i++) {
    if (now <= tolerance) return 1;
    if (!find_step(&p, normal)) return 0;
    double length = mhb_norm(newton->step, newton->n + 1), before = now;
    way += length;
    if (!isfinite(length) || way > FARTHEST) return 0;
    move(&p, 1, x, omega);
    if (!(*omega > 0)) return 0;
    now = measure(&p, x, *omega);
    if (before <= ROUNDING && now > 0.5 * before) return now <= ROUNDING;
    double cut = 1; /* measure does not change the step */
    for (int h = 0; h < MAX_HALVINGS && !(now <= before); h++) {
      cut *= 0.5;
      move(&p, -cut, x, omega);
      now = measure(&p, x, *omega);
    }
  }
  return 0;
}
