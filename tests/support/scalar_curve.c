#include "tests/support/scalar_curve.h"

#include <math.h>
#include <stdlib.h>

#include "mhb/continuation/corrector.h"
#include "tests/support/check.h"

typedef struct {
  mhb_curve_system base; /* first: the functions of the system get it back */
  scalar_function  f;
  double           a[2][2]; /* [f_x column; row], last factored */
  double           determinant;
} scalar_system;

static scalar_system *of(mhb_curve_system *system) {
  return (scalar_system *)system;
}

static void destroy(mhb_curve_system *system) {
  free(system);
}

static void linearise(mhb_curve_system *system, mhb_curve_point *p) {
  p->r[0] = of(system)->f(p->x[0], p->value, &of(system)->a[0][0], &p->slope[0]);
}

static void evaluate(mhb_curve_system *system, mhb_curve_point *p) {
  double unused[2];
  p->r[0] = of(system)->f(p->x[0], p->value, &unused[0], &unused[1]);
}

static int factor(mhb_curve_system *system, const mhb_curve_point *p, const double *column,
                  const double *row) {
  scalar_system *s = of(system);
  double         f_value;
  s->f(p->x[0], p->value, &s->a[0][0], &f_value);
  s->a[0][1]     = column[0];
  s->a[1][0]     = row[0];
  s->a[1][1]     = row[1];
  s->determinant = s->a[0][0] * s->a[1][1] - s->a[0][1] * s->a[1][0];
  return s->determinant != 0;
}

static int solve(mhb_curve_system *system, double *rhs) {
  const scalar_system *s = of(system);
  double               x = (s->a[1][1] * rhs[0] - s->a[0][1] * rhs[1]) / s->determinant;
  rhs[1]                 = (s->a[0][0] * rhs[1] - s->a[1][0] * rhs[0]) / s->determinant;
  rhs[0]                 = x;
  return isfinite(rhs[0]) && isfinite(rhs[1]);
}

static int sign(const mhb_curve_system *system) {
  return ((const scalar_system *)system)->determinant < 0 ? -1 : 1;
}

static mhb_reason solve_at_value(mhb_curve_system *system, double tolerance, mhb_curve_point *p) {
  for (p->iterations = 0; p->iterations < 50; p->iterations++) {
    double f_x, f_value, r = of(system)->f(p->x[0], p->value, &f_x, &f_value);
    if (fabs(r) <= tolerance * fmax(fabs(p->x[0]), 1e-300)) return MHB_CONVERGED;
    p->x[0] -= r / f_x;
  }
  return MHB_MAX_ITERATIONS;
}

mhb_arclength *scalar_curve(scalar_function f, double low, double high) {
  mhb_arclength *curve;
  scalar_system *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->f    = f;
  s->base = (mhb_curve_system){.n              = 1,
                               .least          = -INFINITY,
                               .smooth         = true,
                               .row_length     = 1,
                               .copies         = 1,
                               .destroy        = destroy,
                               .linearise      = linearise,
                               .evaluate       = evaluate,
                               .factor         = factor,
                               .solve          = solve,
                               .sign           = sign,
                               .solve_at_value = solve_at_value};
  curve   = mhb_arclength_create(&s->base, low, high);
  return curve;
}

void scalar_point(mhb_arclength *curve, double x, double value, double dx, double dvalue,
                  mhb_curve_point *point) {
  const double along[] = {dx, dvalue};
  point->x[0]          = x;
  point->value         = value;
  mhb_arclength_measure(curve, point);
  assert_true(mhb_arclength_set_tangent(curve, along, point));
}

void scalar_step(mhb_arclength *curve, double x, double value, double next_x, double next_value) {
  scalar_point(curve, x, value, next_x - x, next_value - value, &curve->current);
  scalar_point(curve, next_x, next_value, next_x - x, next_value - value, &curve->next);
}

double scalar_circle(double x, double value, double *f_x, double *f_value) {
  *f_x     = 2 * (x - 3);
  *f_value = 2 * value;
  return (x - 3) * (x - 3) + value * value - 1;
}

double scalar_line(double x, double value, double *f_x, double *f_value) {
  *f_x     = 1;
  *f_value = -1;
  return x - 2 - value;
}

double scalar_cusp(double x, double value, double *f_x, double *f_value) {
  double y = x - 2;
  *f_x     = -3 * y * y;
  *f_value = 2 * value;
  return value * value - y * y * y;
}

double scalar_root_kink(double x, double value, double *f_x, double *f_value) {
  double root = value > 0 ? sqrt(value) : 0;
  *f_x        = 1;
  *f_value    = -1 - (value > 0 ? 0.5 / fmax(root, 1e-9) : 0);
  return x - 2 - value - root;
}

double scalar_nowhere(double x, double value, double *f_x, double *f_value) {
  *f_x     = 2 * x;
  *f_value = 2 * value;
  return x * x + 1 + value * value;
}
