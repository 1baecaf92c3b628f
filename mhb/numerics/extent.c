#include "mhb/numerics/extent.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/vector.h"

enum { AXES = 3, NEWTON_STEPS = 40 };

/* Harmonics below this fraction of the largest do not change any printed figure. */
static const double ROUNDING = 1e-13;

/* Newton's steps below this angle end when they no longer halve: they are round-off then. */
static const double NEAR = 1e-6;

/* A direction counts as flat, and is made to bend, by these parts of the curvature. */
static const double FLAT = 1e-9, SHIFT = 1e-2;

/* Position, velocity and acceleration at phase t; harmonic k has the period 2 pi/k. */
static void orbit_at(int n, int m, const double complex *a, double t, double x[][AXES]) {
  double complex turn = cexp(I * t);
  for (int i = 0; i < n; i++) {
    double complex power = 1, sum[3] = {0};
    for (int k = 0; k <= m; k++, power *= turn) {
      double complex term = a[i * (m + 1) + k] * power;
      sum[0] += term;
      sum[1] += I * k * term;
      sum[2] -= (double)k * k * term;
    }
    for (int d = 0; d < 3; d++) x[d][i] = creal(sum[d]);
  }
}

/* Distance of the instants, d = x(t) - x(s), and Newton's step to its maximum. */
typedef struct {
  mhb_extent at;
  double     dt, ds;
} ascent;

/* The Hessian of g(t, s) = |x(t) - x(s)|^2 is shifted where it is not negative definite. */
static ascent ascent_at(int n, int m, const double complex *a, double t, double s) {
  ascent out = {.at = {.t = t, .s = s}};
  double x[3][AXES], y[3][AXES], d[AXES] = {0};
  orbit_at(n, m, a, t, x);
  orbit_at(n, m, a, s, y);
  for (int i = 0; i < n; i++) d[i] = x[0][i] - y[0][i];
  const double length = sqrt(mhb_dot(n, d, d));
  out.at.length       = length;
  for (int i = 0; i < n; i++) out.at.direction[i] = length > 0 ? d[i] / length : 0;
  const double gt = mhb_dot(n, d, x[1]), gs = -mhb_dot(n, d, y[1]), ts = -mhb_dot(n, x[1], y[1]);
  double       tt   = mhb_dot(n, x[1], x[1]) + mhb_dot(n, d, x[2]);
  double       ss   = mhb_dot(n, y[1], y[1]) - mhb_dot(n, d, y[2]);
  const double size = fabs(tt) + fabs(ss), most = 0.5 * (tt + ss) + hypot(0.5 * (tt - ss), ts);
  if (most > -FLAT * size) {
    tt -= most + SHIFT * size;
    ss -= most + SHIFT * size;
  }
  const double det = tt * ss - ts * ts;
  if (!(det > 0)) return out; /* at rest */
  out.dt = -(ss * gt - ts * gs) / det;
  out.ds = -(tt * gs - ts * gt) / det;
  return out;
}

/* Newton's method from a sampled maximum, its steps halved where the distance falls. The distance
 * is exact to rounding when the instants are known to the root of it only. So the steps go on until
 * they are round-off: derivatives of D need the instants. */
static mhb_extent refined(int n, int m, const double complex *a, double t, double s) {
  ascent best = ascent_at(n, m, a, t, s);
  double last = INFINITY, part = 1;
  for (int step = 0; step < NEWTON_STEPS; step++) {
    const double moved = part * hypot(best.dt, best.ds);
    if (moved == 0 || (last < NEAR && moved > 0.5 * last)) break;
    const ascent next = ascent_at(n, m, a, best.at.t + part * best.dt, best.at.s + part * best.ds);
    if (next.at.length < best.at.length * (1 - ROUNDING)) {
      part *= 0.5;
      continue;
    }
    last = moved;
    part = 1;
    best = next;
  }
  return best.at;
}

/* Samples of the motion, without its mean. */
typedef struct {
  int           n, samples;
  const double *x; /* [samples][n] */
} track;

static double squared_distance(const track *o, int i, int j) {
  const double *x = o->x + i * o->n, *y = o->x + j * o->n;
  double        g = 0;
  for (int k = 0; k < o->n; k++) g += (x[k] - y[k]) * (x[k] - y[k]);
  return g;
}

/* Whether no neighbour on the grid of pairs is farther apart. */
static bool is_summit(const track *o, int i, int j, double g) {
  const int N = o->samples;
  for (int di = -1; di <= 1; di++)
    for (int dj = -1; dj <= 1; dj++)
      if (squared_distance(o, (i + di + N) % N, (j + dj + N) % N) > g) return false;
  return true;
}

/* The best of all summits that may be the highest. Between samples g is higher by 16 % at most: the
 * phase of the highest harmonic is off by pi/8 at each instant. */
static mhb_extent best_summit(const track *o, int m, const double complex *a) {
  const double step = SHB_TWO_PI / o->samples, below = 0.84;
  double       most = 0, in_row[o->samples];
  mhb_extent   best = {0};
  for (int i = 0; i < o->samples; i++) {
    in_row[i] = 0;
    for (int j = 0; j < i; j++) in_row[i] = fmax(in_row[i], squared_distance(o, i, j));
    most = fmax(most, in_row[i]);
  }
  for (int i = 0; i < o->samples; i++)
    for (int j = 0; j < i && in_row[i] >= below * most; j++) {
      const double g = squared_distance(o, i, j);
      if (g < below * most || !is_summit(o, i, j, g)) continue;
      const mhb_extent summit = refined(o->n, m, a, i * step, j * step);
      if (summit.length > best.length) best = summit;
    }
  return best;
}

static mhb_extent extent(int n, int m, const double complex *a) {
  int    samples = 8 * (m + 1);
  double x[samples * n]; /* 200 harmonics on three axes: 39 kB */
  for (int i = 0; i < samples; i++) {
    double complex turn = cexp(I * (SHB_TWO_PI * i / samples));
    for (int axis = 0; axis < n; axis++) {
      double complex sum = 0;
      for (int k = m; k >= 1; k--) sum = (sum + a[axis * (m + 1) + k]) * turn;
      x[i * n + axis] = creal(sum); /* the mean cancels in a difference */
    }
  }
  return best_summit(&(const track){n, samples, x}, m, a);
}

/* Highest harmonic of a [n][m + 1] above rounding. */
static int highest(int n, int m, const double complex *a) {
  double most = 0;
  for (int i = 0; i < n * (m + 1); i++)
    if (i % (m + 1)) most = fmax(most, cabs(a[i]));
  for (int k = m; k > 1; k--)
    for (int axis = 0; axis < n; axis++)
      if (cabs(a[axis * (m + 1) + k]) > ROUNDING * most) return k;
  return m < 1 ? m : 1;
}

/* The search for the largest distance takes a time of the square of the harmonics: omit vanishing
 * ones. */
mhb_extent mhb_extent_of(int n, int m, const double complex *a) {
  int            top = highest(n, m, a);
  double complex held[n * (top + 1)];
  for (int axis = 0; axis < n; axis++)
    memcpy(held + axis * (top + 1), a + axis * (m + 1), sizeof *held * (size_t)(top + 1));
  return extent(n, top, held);
}

void mhb_extent_weight(const mhb_extent *extent, int n, int k, double complex *weight) {
  const double complex apart = cexp(I * k * extent->t) - cexp(I * k * extent->s);
  for (int i = 0; i < n; i++) weight[i] = extent->direction[i] * apart;
}

static double square(double complex a) {
  return creal(a) * creal(a) + cimag(a) * cimag(a);
}

double mhb_semi_major_axis(int n, const double complex *a, int stride) {
  double         sum     = 0;
  double complex squared = 0;
  for (int i = 0; i < n; i++) {
    const double complex z = a[i * stride];
    sum += square(z);
    squared += z * z;
  }
  return sqrt((sum + cabs(squared)) / 2);
}

double mhb_semi_major_weight(const double complex a[3], double complex weight[3]) {
  const double         A      = mhb_semi_major_axis(3, a, 1);
  const double complex Q      = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
  const double         length = cabs(Q);
  const double complex turn   = length > 0 ? conj(Q) / length : 0;
  for (int i = 0; i < 3; i++) weight[i] = A > 0 ? 0.5 * (conj(a[i]) + turn * a[i]) / A : 0;
  return A;
}

double mhb_rss_weight(const double complex a[3], double complex weight[3]) {
  const double A = sqrt(square(a[0]) + square(a[1]) + square(a[2]));
  for (int i = 0; i < 3; i++) weight[i] = A > 0 ? conj(a[i]) / A : 0;
  return A;
}
