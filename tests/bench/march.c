/* The two marches of baseline.h. */
#include <math.h>

#include "baseline.h"

/* The trial force of a stick step, returned to the friction circle where it is outside. */
BASELINE_HOT void baseline_march_return(const baseline *b, const baseline_law *law, int from,
                                        int to) {
  const double *x1 = b->x[0], *x2 = b->x[1];
  double        f[2] = {b->f[0][from], b->f[1][from]};
  for (int i = from; i < to; i++) {
    double g[2]  = {f[0] + (x1[i + 1] - x1[i]), f[1] + (x2[i + 1] - x2[i])};
    double limit = b->limit[i + 1], square = g[0] * g[0] + g[1] * g[1];
    if (square <= limit * limit) {
      f[0] = g[0];
      f[1] = g[1];
    } else if (law->isotropic) {
      double shrink = limit / sqrt(square);
      f[0]          = g[0] * shrink;
      f[1]          = g[1] * shrink;
    } else {
      baseline_return(law->k, g, limit, f);
    }
    b->f[0][i + 1] = f[0];
    b->f[1][i + 1] = f[1];
  }
}

/* ln(n1/n0)/(n1 - n0), both positive. */
static double log_mean(double n0, double n1) {
  double q = (n1 - n0) / (n1 + n0), square = q * q;
  if (square > .01) return log(n1 / n0) / (n1 - n0);
  return 2 / (n0 + n1) * (1 + square * (1. / 3 + square * (1. / 5 + square / 7)));
}

/* exp(-z), z <= 64: Taylor to degree 6 of z/256, squared eight times. A loop of it becomes SIMD. */
static inline double decay_of(double z) {
  double y = z * (-1. / 256), square = y * y;
  double e =
      1 + y +
      square * (.5 + y * (1. / 6) + square * (1. / 24 + y * (1. / 120) + square * (1. / 720)));
  for (int i = 0; i < 8; i++) e *= e;
  return e;
}

/* decay = exp(-|dx| ln(n1/n0) / (mu (n1 - n0))) of each whole step; unused where a step opens or
 * closes. */
BASELINE_HOT void baseline_prepare_closed(const baseline *b, const baseline_law *law) {
  const double *restrict n = b->n, *restrict x1 = b->x[0], *restrict x2 = b->x[1];
  double *restrict length = b->length, *restrict d1 = b->d[0], *restrict d2 = b->d[1];
  double *restrict z = b->z, *restrict decay = b->decay;
  double twice = 2 / law->mu;
  for (int i = 0; i < b->N; i++) {
    double dx[2] = {x1[i + 1] - x1[i], x2[i + 1] - x2[i]};
    double size = sqrt(dx[0] * dx[0] + dx[1] * dx[1]), inverse = 1 / (size + 1e-300);
    length[i] = size;
    d1[i]     = (dx[0] + 1e-300) * inverse; /* no move: some unit vector */
    d2[i]     = dx[1] * inverse;
  }
  if (!law->isotropic) return;
  for (int i = 0; i < b->N; i++) {
    double inverse = 1 / (n[i] + n[i + 1]), q = (n[i + 1] - n[i]) * inverse, square = q * q;
    z[i] = length[i] * twice * inverse *
           (1 + square * (1. / 3 + square * (1. / 5 + square * (1. / 7))));
  }
  for (int i = 0; i < b->N; i++) { /* the series of log_mean does not reach there */
    double sum = n[i] + n[i + 1];
    if (fabs(n[i + 1] - n[i]) <= .1 * sum || n[i] <= 0 || n[i + 1] <= 0) continue;
    z[i] = length[i] / law->mu * log_mean(n[i], n[i + 1]);
  }
  for (int i = 0; i < b->N; i++) z[i] = z[i] < 64 ? z[i] : 64;
  for (int i = 0; i < b->N; i++) decay[i] = decay_of(z[i]);
}

/* Direction after slip along d while tan(angle/2) falls by the factor decay, without any angle. */
static inline void turn(const double d[2], double decay, double e[2]) {
  double c = e[0] * d[0] + e[1] * d[1], s = d[0] * e[1] - d[1] * e[0];
  double near = 1 + c, far = (1 - c) * decay * decay, scale = 1 / (near + far);
  c    = (near - far) * scale;
  s    = 2 * decay * s * scale;
  e[0] = c * d[0] - s * d[1];
  e[1] = c * d[1] + s * d[0];
}

/* Slip from f over a move dx to |f| = limit by the midpoint rule, f1 = f + dx - lambda K (f +
 * f1)/2. The rule may have no solution if the load more than halves. Then, and if Newton's method
 * fails, the implicit step is taken. Returns whether the contact still slides. */
static int midpoint(const double k[2], const double dx[2], double before, double limit,
                    double f[2]) {
  double g[2] = {f[0] + dx[0], f[1] + dx[1]};
  double p[2] = {f[0] + g[0], f[1] + g[1]}, f1[2], lambda = 0;
  double target = limit * limit, square = g[0] * g[0] + g[1] * g[1];
  if (square <= target) {
    f[0] = g[0];
    f[1] = g[1];
    return 0;
  }
  for (int i = 0; i < 8 && limit > .5 * before; i++) {
    double a[2] = {1 / (1 + .5 * lambda * k[0]), 1 / (1 + .5 * lambda * k[1])}, slope = 0;
    for (int j = 0; j < 2; j++) {
      f1[j] = p[j] * a[j] - f[j];
      slope += k[j] * a[j] * a[j] * p[j] * f1[j];
    }
    double excess = f1[0] * f1[0] + f1[1] * f1[1] - target;
    if (fabs(excess) < 1e-9 * target) {
      f[0] = f1[0];
      f[1] = f1[1];
      return 1;
    }
    lambda += excess / slope;
    if (!(lambda >= 0)) break;
  }
  baseline_return(k, g, limit, f);
  return 1;
}

/* Fraction of the step after which |f + tau dx| first exceeds mu (n0 + tau dn); above 1: not in
 * this step. */
static double onset(const double f[2], const double dx[2], double mu, double n0, double dn) {
  double a = dx[0] * dx[0] + dx[1] * dx[1] - mu * mu * dn * dn;
  double b = f[0] * dx[0] + f[1] * dx[1] - mu * mu * n0 * dn;
  double c = fmin(f[0] * f[0] + f[1] * f[1] - mu * mu * n0 * n0, 0);
  if (a + 2 * b + c <= 0 && (a >= 0 || b <= 0)) return 2;
  double root = b * b - a * c;
  if (root < 0) return 2;
  root = sqrt(root);
  return b > 0 ? -c / (b + root) : (root - b) / a;
}

/* One step from a contact that sticks at its start; returns whether it slides at the end. */
static int stick_step(const baseline *b, const baseline_law *law, int i, double f[2], double e[2]) {
  double dx[2] = {b->x[0][i + 1] - b->x[0][i], b->x[1][i + 1] - b->x[1][i]};
  double n0 = b->n[i], n1 = b->n[i + 1], tau = onset(f, dx, law->mu, n0, n1 - n0);
  if (!(tau <= 1)) {
    f[0] += dx[0];
    f[1] += dx[1];
    return 0;
  }
  double n = n0 + tau * (n1 - n0), left[2] = {(1 - tau) * dx[0], (1 - tau) * dx[1]};
  for (int j = 0; j < 2; j++) f[j] += tau * dx[j];
  if (law->isotropic) {
    double size = hypot(f[0], f[1]), d[2] = {b->d[0][i], b->d[1][i]};
    for (int j = 0; j < 2; j++) e[j] = size > 0 ? f[j] / size : d[j];
    turn(d, exp(-(1 - tau) * b->length[i] / law->mu * log_mean(n, n1)), e);
    for (int j = 0; j < 2; j++) f[j] = law->mu * n1 * e[j];
    return 1;
  }
  int slides = midpoint(law->k, left, law->mu * n, law->mu * n1, f);
  for (int j = 0; j < 2; j++) e[j] = f[j] / (law->mu * n1);
  return slides;
}

/* One step in which the contact closes (eqs. 13-15); returns whether it slides at the end. */
static int closing_step(const baseline *b, const baseline_law *law, int i, double f[2],
                        double e[2]) {
  double n1 = b->n[i + 1], dn = n1 - b->n[i], d[2] = {b->d[0][i], b->d[1][i]};
  double rate = law->mu * dn, reach = b->length[i] * n1 / dn;
  if (b->length[i] <= rate) {
    for (int j = 0; j < 2; j++) f[j] = reach * d[j];
    return 0;
  }
  for (int j = 0; j < 2; j++) e[j] = d[j];
  if (!law->isotropic) {
    double ratio = b->length[i] / rate;
    baseline_return(law->k, (double[2]){ratio * d[0], ratio * d[1]}, 1, e);
  }
  for (int j = 0; j < 2; j++) f[j] = law->mu * n1 * e[j];
  return 1;
}

static inline int slip_step(const baseline *b, const baseline_law *law, int i, double f[2],
                            double e[2]) {
  double limit = b->limit[i + 1], d[2] = {b->d[0][i], b->d[1][i]};
  if (law->isotropic) {
    turn(d, b->decay[i], e);
    for (int j = 0; j < 2; j++) f[j] = limit * e[j];
    return 1;
  }
  double dx[2]  = {b->length[i] * d[0], b->length[i] * d[1]};
  int    slides = midpoint(law->k, dx, b->limit[i], limit, f);
  for (int j = 0; j < 2; j++) e[j] = f[j] / limit;
  return slides;
}

/* With s and n linear, slip lasts to the end of a step; the state is decided at the start of each
 * step. */
BASELINE_HOT void baseline_march_closed(const baseline *b, const baseline_law *law, int from,
                                        int to, int *sliding) {
  double f[2] = {b->f[0][from], b->f[1][from]}, e[2] = {1, 0};
  int    slides = *sliding;
  if (slides)
    for (int j = 0; j < 2; j++) e[j] = f[j] / b->limit[from];
  for (int i = from; i < to; i++) {
    double n0 = b->n[i], n1 = b->n[i + 1];
    if (slides)
      slides = b->length[i] * (e[0] * b->d[0][i] + e[1] * b->d[1][i]) > law->mu * (n1 - n0);
    if (n1 <= 0) {
      f[0] = f[1] = 0;
      slides      = 0;
    } else if (n0 <= 0) {
      slides = closing_step(b, law, i, f, e);
    } else if (slides) {
      slides = slip_step(b, law, i, f, e);
    } else {
      slides = stick_step(b, law, i, f, e);
    }
    b->f[0][i + 1] = f[0];
    b->f[1][i + 1] = f[1];
  }
  *sliding = slides;
}
