#include "mesh/base/root.h"

#include <float.h>
#include <math.h>

/* Truncation kappa_1 L^2, kappa_1 = 0.2 / first L; one step more than bisection (n_0 = 1). */
static const double TRUNCATION = .2, SLACK = 2;

static void end_at(shb_root *root, double x) {
  root->x[0] = root->x[1] = x;
  root->f[0] = root->f[1] = 0;
}

bool shb_root_start(shb_root *root, double a, double fa, double b, double fb, double tolerance) {
  *root = (shb_root){.x = {a, b}, .f = {fa, fb}};
  if (a > b) *root = (shb_root){.x = {b, a}, .f = {fb, fa}};
  root->tolerance = fmax(tolerance, DBL_EPSILON * fmax(fabs(a), fabs(b)));
  root->first     = root->x[1] - root->x[0];
  root->budget    = .5 * SLACK * root->tolerance;
  while (root->budget < .5 * SLACK * root->first && root->budget > 0) root->budget *= 2;
  if (fa == 0 || fb == 0) end_at(root, fa == 0 ? a : b);
  return fa == 0 || fb == 0 || (fa < 0 && fb > 0) || (fa > 0 && fb < 0);
}

bool shb_root_done(const shb_root *root) {
  double middle = .5 * (root->x[0] + root->x[1]);
  return root->x[1] - root->x[0] <= root->tolerance || middle <= root->x[0] || middle >= root->x[1];
}

/* A step of length at most `most` from x towards `to`. */
static double towards(double x, double to, double most) {
  return x + copysign(fmin(most, fabs(to - x)), to - x);
}

double shb_root_next(const shb_root *root) {
  static const double other[] = {.5, .2, .8, .05, .95};
  const double        a = root->x[0], b = root->x[1], length = b - a, middle = .5 * (a + b);
  if (root->n_failed > 0) return a + other[root->n_failed - 1] * length;
  double x = (a * root->f[1] - b * root->f[0]) / (root->f[1] - root->f[0]); /* interpolate */
  if (!(x > a && x < b)) return middle;
  x           = towards(x, middle, TRUNCATION * length * length / root->first); /* truncate */
  double most = fmax(root->budget - .5 * length, 0);
  if (fabs(x - middle) > most) x = middle + copysign(most, x - middle); /* project */
  return x > a && x < b ? x : middle;
}

void shb_root_found(shb_root *root, double x, double f) {
  root->n_failed = 0;
  root->budget *= .5;
  if (f == 0) {
    end_at(root, x);
    return;
  }
  int side      = (f > 0) != (root->f[0] > 0);
  root->x[side] = x;
  root->f[side] = f;
}

bool shb_root_failed(shb_root *root) {
  return root->n_failed++ < 5;
}
