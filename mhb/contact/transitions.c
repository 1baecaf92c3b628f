#include "mhb/contact/transitions.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

/* A scalar function of the signals: n itself, or g = |x - z|^2 - mu^2 n^2. */
typedef struct {
  const mhb_signals *signals;
  int                is_load;
  double             mu, z[2];
  double             bound3, bound4; /* on the third and fourth derivative */
} event_function;

typedef struct {
  double t, y, dy;
} sample;

static void combine(const event_function *f, const double v[3], const double dv[3], sample *s) {
  if (f->is_load) {
    s->y  = v[0];
    s->dy = dv[0];
    return;
  }
  double a = v[1] - f->z[0], b = v[2] - f->z[1], mu2 = f->mu * f->mu;
  s->y  = a * a + b * b - mu2 * v[0] * v[0];
  s->dy = 2 * (a * dv[1] + b * dv[2] - mu2 * v[0] * dv[0]);
}

static sample sample_at(const event_function *f, double t) {
  sample s = {.t = t};
  double v[3], dv[3];
  mhb_signals_at(f->signals, t, v, dv, NULL);
  combine(f, v, dv, &s);
  return s;
}

/* Grid point i (any integer; the grid is periodic). */
static sample sample_grid(const event_function *f, int i) {
  int    n  = f->signals->n_grid;
  sample s  = {.t = SHB_TWO_PI * i / n};
  int    at = ((i % n) + n) % n;
  double v[3], dv[3];
  for (int k = 0; k < 3; k++) {
    v[k]  = f->signals->value[k][at];
    dv[k] = f->signals->slope[k][at];
  }
  combine(f, v, dv, &s);
  return s;
}

static double min4(double a, double b, double c, double d) {
  return mhb_least(mhb_least(a, b), mhb_least(c, d));
}

static double max4(double a, double b, double c, double d) {
  return mhb_most(mhb_most(a, b), mhb_most(c, d));
}

/* Root of the cubic Hermite interpolant in a bracket with one sign change. */
static double cubic_root(const sample *lo, const sample *hi) {
  double h = hi->t - lo->t, a = h * lo->dy, b = h * hi->dy, rise = hi->y - lo->y;
  double c2 = 3 * rise - 2 * a - b, c3 = a + b - 2 * rise, s = -lo->y / rise;
  for (int i = 0; i < 4; i++) {
    double slope = a + s * (2 * c2 + 3 * c3 * s);
    s -= (lo->y + s * (a + s * (c2 + s * c3))) / slope;
  }
  return s > 0 && s < 1 ? lo->t + h * s : lo->t - h * lo->y / rise;
}

/* A sample with y'' and the signals. */
typedef struct {
  sample at;
  double bend, v[3], dv[3], ddv[3];
} jet;

static jet jet_at(const event_function *f, double t) {
  jet s = {.at = {.t = t}};
  mhb_signals_at(f->signals, t, s.v, s.dv, s.ddv);
  combine(f, s.v, s.dv, &s.at);
  const double *v = s.v, *dv = s.dv, *ddv = s.ddv, mu2 = f->mu * f->mu;
  double        a = v[1] - f->z[0], b = v[2] - f->z[1];
  s.bend = f->is_load ? ddv[0]
                      : 2 * (dv[1] * dv[1] + dv[2] * dv[2] + a * ddv[1] + b * ddv[2] -
                             mu2 * (dv[0] * dv[0] + v[0] * ddv[0]));
  return s;
}

/* A root, and the signals there. */
typedef struct {
  double t, v[3];
} crossing;

static crossing crossing_at(const jet *s, double moved) {
  crossing root = {.t = s->at.t + moved};
  for (int i = 0; i < 3; i++) root.v[i] = s->v[i] + moved * (s->dv[i] + .5 * moved * s->ddv[i]);
  return root;
}

/* Safeguarded Newton with the second derivative (Chebyshev), in a bracket with one sign change. The
 * error is cubic in the step. */
static crossing refine_root(const event_function *f, sample lo, sample hi) {
  int    rising = hi.y > lo.y;
  double t      = cubic_root(&lo, &hi);
  jet    s;
  for (int i = 0; i < 60; i++) {
    s = jet_at(f, t);
    if ((s.at.y > 0) == rising) {
      hi = s.at;
    } else {
      lo = s.at;
    }
    if (hi.t - lo.t < 1e-15) break;
    double step = -s.at.y / s.at.dy, ratio = s.bend / s.at.dy, more = -.5 * ratio * step;
    if (fabs(more) < .3) step *= 1 + more;
    int inside = t + step >= lo.t && t + step <= hi.t;
    if (inside && fabs(step * step * step) * (1 + ratio * ratio) < 1e-17)
      return crossing_at(&s, step);
    t = inside ? t + step : .5 * (lo.t + hi.t);
  }
  return crossing_at(&s, 0);
}

/* First root in (a, b] where y goes from sign to -sign (sign -1: rising). 1: *root is set. */
static int first_crossing(const event_function *f, double sign, sample a, sample b,
                          crossing *root) {
  double h = b.t - a.t, slack = h * h * h * h * f->bound4 / 384;
  double p = a.y + h * a.dy / 3, q = b.y - h * b.dy / 3;
  double worst = sign > 0 ? min4(a.y, p, q, b.y) : -max4(a.y, p, q, b.y);
  if (worst > slack) return 0;
  int changes = sign * b.y < 0 && sign * a.y >= 0;
  if (h < 1e-10) {
    if (!changes) return 0;
    jet s = jet_at(f, b.t);
    *root = crossing_at(&s, 0);
    return 1;
  }
  /* the cubic's slope has Bezier points dy0, 3 (q - p)/h, dy1, and an error below h^3 M4
   * sqrt(3)/216 */
  double steep  = h * h * h * f->bound4 * .0081;
  double middle = 3 * (q - p) / h;
  double top    = mhb_most(mhb_most(a.dy, b.dy), middle),
         bottom = mhb_least(mhb_least(a.dy, b.dy), middle);
  double least = sign > 0 ? -top : bottom, away = sign > 0 ? bottom : -top;
  if (away > steep && sign * a.y >= 0) return 0;
  if (least > steep) {
    if (!changes) return 0;
    *root = refine_root(f, a, b);
    return 1;
  }
  sample mid = sample_at(f, .5 * (a.t + b.t));
  return first_crossing(f, sign, a, mid, root) || first_crossing(f, sign, mid, b, root);
}

/* y and y' on eight grid points from i on. */
MHB_INLINE void grid_lanes(const event_function *f, int i, mhb_lanes *y, mhb_lanes *dy) {
  const mhb_signals *s = f->signals;
  mhb_lanes          n = lanes_load(s->value[0] + i), dn = lanes_load(s->slope[0] + i);
  *y  = n;
  *dy = dn;
  if (f->is_load) return;
  mhb_lanes a = lanes_load(s->value[1] + i) - f->z[0], b = lanes_load(s->value[2] + i) - f->z[1];
  double    mu2 = f->mu * f->mu;
  *y            = a * a + b * b - mu2 * n * n;
  *dy = 2 * (a * lanes_load(s->slope[1] + i) + b * lanes_load(s->slope[2] + i) - mu2 * n * dn);
}

/* First of the cells [from, to) whose hull does not stay on the side of sign; to if all do. Cells
 * are grid cells, any integer. Eight are tested together. */
MHB_HOT static int next_candidate(const event_function *f, double sign, int from, int to) {
  int    n = f->signals->n_grid;
  double h = SHB_TWO_PI / n, third = sign * h / 3, slack = h * h * h * h * f->bound4 / 384;
  for (int i = from; i < to;) {
    int       base = (i % n + n) % n / MHB_LANES * MHB_LANES, skip = (i % n + n) % n - base;
    mhb_lanes y, dy, y1, dy1;
    grid_lanes(f, base, &y, &dy);
    grid_lanes(f, base + 1, &y1, &dy1);
    mhb_lanes      least = lanes_min(lanes_min(sign * y, sign * y1),
                                     lanes_min(sign * y + third * dy, sign * y1 - third * dy1));
    mhb_lanes_bits clear = least > slack;
    for (int l = skip; l < MHB_LANES && i < to; l++, i++)
      if (!clear[l]) return i;
  }
  return to;
}

shb_status mhb_contact_intervals_create(int m, mhb_contact_intervals *closed) {
  int room        = m > 0 ? m : 1;
  *closed         = (mhb_contact_intervals){.room = room};
  closed->closing = calloc(2 * ((size_t)room + 1), sizeof(double));
  SHB_CHECK(closed->closing, SHB_ERR_IO, "out of memory for %d openings", room);
  closed->opening = closed->closing + room + 1;
  return SHB_OK;
}

void mhb_contact_intervals_destroy(mhb_contact_intervals *closed) {
  free(closed->closing);
  *closed = (mhb_contact_intervals){0};
}

void mhb_contact_intervals_find(const mhb_signals *signals, mhb_contact_intervals *closed) {
  event_function f     = {.signals = signals, .is_load = 1, .bound4 = signals->bound[0][4]};
  double         slack = 8 * DBL_EPSILON * signals->bound[0][0];
  closed->n = closed->always_closed = closed->always_open = 0;
  double mean = signals->coefficient[0], swing = signals->bound[0][0] - fabs(mean);
  if (mean >= swing && mean > 0) {
    closed->always_closed = 1;
    return;
  }
  if (-mean >= swing - slack) {
    closed->always_open = 1;
    return;
  }
  int    n = signals->n_grid, first = 0, crossings = 0;
  double negative = 0;
  for (int i = 0; i < n; i++) { /* begin where n is least */
    if (signals->value[0][i] < negative) {
      negative = signals->value[0][i];
      first    = i;
    }
  }
  sample a          = sample_grid(&f, first);
  double sign       = a.y < 0 ? -1 : 1; /* -1: look for a closing */
  int    began_open = a.y < 0;
  for (int i = first; i < first + n; i++) {
    int clear = next_candidate(&f, sign, i, first + n);
    if (clear == first + n) break;
    if (clear > i) a = sample_grid(&f, i = clear);
    sample   b = sample_grid(&f, i + 1), from = a;
    crossing root;
    while (crossings < 2 * closed->room && first_crossing(&f, sign, from, b, &root)) {
      double *list                        = sign < 0 ? closed->closing : closed->opening;
      list[(crossings + !began_open) / 2] = root.t;
      crossings++;
      sign   = -sign;
      from   = sample_at(&f, root.t);
      from.y = 0;
    }
    a = b;
  }
  closed->n = crossings / 2;
  if (closed->n == 0) {
    closed->always_closed = !began_open;
    closed->always_open   = began_open;
    return;
  }
  if (!began_open) {
    /* o_0 c_1 o_1 ... c_n alternate: pair each closing with the next opening */
    double last = closed->opening[0] + SHB_TWO_PI;
    for (int i = 0; i < closed->n; i++) {
      closed->closing[i] = closed->closing[i + 1];
      closed->opening[i] = i + 1 < closed->n ? closed->opening[i + 1] : last;
    }
  }
}

/* Bounds on derivatives of |x - z|^2 - mu^2 n^2 by Leibniz' rule. */
static void friction_bounds(event_function *f) {
  const mhb_signals *s = f->signals;
  f->bound3 = f->bound4 = 0;
  for (int i = 0; i < 3; i++) {
    const double *D  = s->bound[i];
    double        d0 = D[0] + (i ? fabs(f->z[i - 1]) : 0), weight = i ? 1 : f->mu * f->mu;
    f->bound3 += weight * (2 * d0 * D[3] + 6 * D[1] * D[2]);
    f->bound4 += weight * (2 * d0 * D[4] + 8 * D[1] * D[3] + 6 * D[2] * D[2]);
  }
}

/* A start strictly inside the stick region. Where g is a double zero at from,
 *   g <= t^2/2 (g'' + t M3/3) < 0  for t < -3 g''/M3. */
static sample stick_start(const event_function *f, double from, double to) {
  jet    s     = jet_at(f, from);
  double scale = f->z[0] * f->z[0] + f->z[1] * f->z[1] +
                 f->signals->bound[1][0] * f->signals->bound[1][0] +
                 f->signals->bound[2][0] * f->signals->bound[2][0];
  double limit = f->mu * s.v[0], step = 1e-6;
  if (s.at.y < -1e-11 * limit * limit - 4e-15 * scale) return s.at;
  if (s.bend < 0 && f->bound3 > 0) step = mhb_most(step, mhb_least(1.0, -1.5 * s.bend / f->bound3));
  return sample_at(f, mhb_least(from + step, to));
}

double mhb_slip_onset(const mhb_signals *signals, double mu, const double z[2], double from,
                      double to, double value[3]) {
  event_function f = {.signals = signals, .mu = mu, .z = {z[0], z[1]}};
  friction_bounds(&f);
  sample a = stick_start(&f, from, to);
  if (a.t >= to) return to + 1;
  if (a.y > 0 && a.dy > 0) {
    double slope[3];
    mhb_signals_at(signals, a.t, value, slope, NULL);
    return a.t;
  }
  a.y         = mhb_least(a.y, 0); /* rounding */
  double cell = SHB_TWO_PI / signals->n_grid;
  int    i = (int)floor(a.t / cell) + 1, last = (int)floor(to / cell);
  for (crossing root; a.t < to; i++) {
    sample b = cell * i < to ? sample_grid(&f, i) : sample_at(&f, to);
    if (b.t <= a.t) continue;
    if (first_crossing(&f, -1, a, b, &root)) {
      memcpy(value, root.v, sizeof root.v);
      return root.t;
    }
    a         = b;
    int clear = i < last ? next_candidate(&f, -1, i, last) : i;
    if (clear > i) a = sample_grid(&f, i = clear);
  }
  return to + 1;
}
