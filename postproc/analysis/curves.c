#include "postproc/analysis/curves.h"

#include <math.h>
#include <stdlib.h>

static const double RIPPLE         = 0.02; /* relative to the peak's height */
static const double LARGEST_GAIN   = 1.05; /* of a refined peak relative to its highest point */
static const double LEAST_FOLD_GAP = 1e-5; /* relative to x, as in the solver */
static const double ROUNDING       = 1e-9; /* relative to x: no reversal */
static const double HAIR           = 0.01; /* of the distance from the peak: no real fold between */
static const double LEVEL          = 1e-6; /* relative to the amplitude: no visible difference */

/* A curve with the scales of its dimensionless arclength. */
typedef struct {
  int           n;
  const double *x, *a;
  double        x_span, a_span;
} curve;

static double span(int n, const double *x) {
  double lo = INFINITY, hi = -INFINITY;
  for (int i = 0; i < n; i++) {
    lo = fmin(lo, x[i]);
    hi = fmax(hi, x[i]);
  }
  return hi > lo ? hi - lo : 1;
}

static curve curve_of(int n, const double *x, const double *a) {
  return (curve){n, x, a, span(n, x), span(n, a)};
}

static double chord(const curve *c, int i, int j) {
  return hypot((c->x[j] - c->x[i]) / c->x_span, (c->a[j] - c->a[i]) / c->a_span);
}

bool post_left_range(int n, const double *x, const double *amplitude, int i) {
  if (i < 0 || i + 1 >= n || x[i] != x[i + 1]) return false;
  double before = i > 0 ? x[i - 1] - x[i] : 0, after = i + 2 < n ? x[i + 2] - x[i] : 0;
  bool   ends = (i == 0 || before != 0) && (i + 2 >= n || after != 0) && before * after >= 0;
  return ends &&
         fabs(amplitude[i + 1] - amplitude[i]) > LEVEL * fmax(amplitude[i], amplitude[i + 1]);
}

static bool is_interrupted(const curve *c, int i) {
  return post_left_range(c->n, c->x, c->a, i);
}

/* The same between point i and the next one in direction step. */
static bool is_interrupted_to(const curve *c, int i, int step) {
  return is_interrupted(c, step > 0 ? i : i - 1);
}

/* Divided differences of the parabola through (s[i], y[i]): y = y0 + d1 (s - s0) + d2 (s - s0)(s -
 * s1). */
static void differences(const double s[3], const double y[3], double d[2]) {
  double first = (y[1] - y[0]) / (s[1] - s[0]), second = (y[2] - y[1]) / (s[2] - s[1]);
  d[0] = first;
  d[1] = (second - first) / (s[2] - s[0]);
}

static double parabola(const double s[3], const double y[3], double at) {
  double d[2];
  differences(s, y, d);
  return y[0] + (at - s[0]) * (d[0] + (at - s[1]) * d[1]);
}

/* Vertex of the parabola; s[1] if it is a line or its vertex lies outside the three points. */
static double vertex(const double s[3], const double y[3]) {
  double d[2];
  differences(s, y, d);
  double at = (s[0] + s[1]) / 2 - d[0] / (2 * d[1]);
  return at >= s[0] && at <= s[2] ? at : s[1];
}

/* Abscissa s of the parabola through i - 1, i, i + 1, with s[1] = 0. It is the coordinate x where x
 * is monotone and not too unevenly spaced. Near a resonance or a smooth fold this is exact to third
 * order. Else it is arclength. False at an end of the curve or where points coincide. */
static bool parabola_abscissa(const curve *c, int i, const double *x, double s[3]) {
  if (i <= 0 || i >= c->n - 1) return false;
  double before = x[i] - x[i - 1], after = x[i + 1] - x[i], ratio = after / before;
  s[0] = -chord(c, i - 1, i);
  s[1] = 0;
  s[2] = chord(c, i, i + 1);
  if (before != 0 && ratio > 0.1 && ratio < 10) {
    s[0] = -fabs(before);
    s[2] = fabs(after);
  }
  return s[0] < 0 && s[2] > 0;
}

static void refine_peak(const curve *c, int i, post_peak *peak) {
  double s[3], a[3], q[3];
  peak->at        = c->x[i];
  peak->amplitude = c->a[i];
  if (!parabola_abscissa(c, i, c->x, s) || s[2] > -10 * s[0] || -s[0] > 10 * s[2]) return;
  for (int k = 0; k < 3; k++) {
    a[k] = c->a[i - 1 + k] / c->a[i];
    q[k] = -1 / fmax(a[k] * a[k], 1e-30);
  }
  double at = vertex(s, q), top = parabola(s, q, at);
  bool   resonant = top <= -0.7; /* else the points are too few or too uneven for 1/a^2 */
  if (!resonant) {
    at  = vertex(s, a);
    top = parabola(s, a, at);
  }
  double gain = fmax(1, resonant ? 1 / sqrt(-top) : top), f = parabola(s, c->x + i - 1, at);
  double low  = fmin(c->x[i], fmin(c->x[i - 1], c->x[i + 1]));
  double high = fmax(c->x[i], fmax(c->x[i - 1], c->x[i + 1]));
  if (f < low || f > high || gain > LARGEST_GAIN) return; /* too coarse to refine the point */
  peak->at        = f;
  peak->amplitude = c->a[i] * gain;
}

/* x where the amplitude falls to level, from the peak in direction step; linear in 1/a^2 between
 * points. NAN if the curve first ends, rises above the peak, or turns back in x by more than a
 * hair. */
static double crossing(const curve *c, const post_peak *peak, int step, double level) {
  double from = peak->at, sign = 0, far = from;
  for (int i = peak->point; i + step >= 0 && i + step < c->n; i += step) {
    double f0 = c->x[i], f1 = c->x[i + step], a0 = c->a[i], a1 = c->a[i + step];
    if (is_interrupted_to(c, i, step)) return NAN;
    if (i == peak->point) { /* the refined peak lies within a point of here */
      f0 = from;
      a0 = peak->amplitude;
      if (a1 >= a0) return NAN;
    }
    if (sign == 0) sign = f1 > from ? 1 : -1;
    far = sign > 0 ? fmax(far, f1) : fmin(far, f1);
    if (sign * (far - f1) > HAIR * fabs(far - from)) return NAN;
    if (a1 > peak->amplitude) return NAN;
    if (a1 <= level) {
      if (a1 <= 0 || a0 <= 0) return f1;
      double q0 = 1 / (a0 * a0), q1 = 1 / (a1 * a1), q = 1 / (level * level);
      return f0 + (f1 - f0) * (q - q0) / (q1 - q0);
    }
  }
  return NAN;
}

static void measure_bandwidth(const curve *c, post_peak *peak) {
  double level  = peak->amplitude / M_SQRT2;
  double before = crossing(c, peak, -1, level), after = crossing(c, peak, 1, level);
  peak->bandwidth = fabs(after - before);
  /* each side must lie on its own side of the peak, else there is a fold between */
  if (!((after - peak->at) * (before - peak->at) < 0)) peak->bandwidth = NAN;
  peak->damping = peak->bandwidth / (2 * peak->at);
}

/* Height above the deeper of the two valleys that separate the point from higher ones. */
static double prominence(const curve *c, int i) {
  double deeper = c->a[i];
  for (int step = -1; step <= 1; step += 2) {
    double valley = c->a[i];
    for (int j = i + step;
         j >= 0 && j < c->n && c->a[j] <= c->a[i] && !is_interrupted_to(c, j, -step); j += step)
      valley = fmin(valley, c->a[j]);
    deeper = step < 0 ? valley : fmax(deeper, valley);
  }
  return c->a[i] - deeper;
}

/* True if the curve rises to i and falls after it, with any run of equal values in between. The
 * fall must exceed a ripple, except for the highest point. */
static bool is_maximum(const curve *c, int i, int top) {
  if (i <= 0 || i >= c->n - 1 || !(c->a[i] > c->a[i - 1])) return false;
  if (is_interrupted(c, i - 1) || is_interrupted(c, i)) return false;
  int j = i + 1;
  while (j < c->n - 1 && c->a[j] == c->a[i]) j++;
  return c->a[j] < c->a[i] && prominence(c, i) >= (i == top ? LEVEL : RIPPLE) * c->a[i];
}

/* True if the curve ends at its first point. */
static bool is_closed(const curve *c) {
  return c->n > 3 &&
         fabs(c->x[c->n - 1] - c->x[0]) <= 1e-8 * fmax(fabs(c->x[0]), 1e-2 * c->x_span) &&
         fabs(c->a[c->n - 1] - c->a[0]) <= 1e-4 * c->a[0];
}

static bool is_level(const curve *c) {
  double lo = INFINITY, hi = 0;
  for (int i = 0; i < c->n; i++) {
    lo = fmin(lo, c->a[i]);
    hi = fmax(hi, c->a[i]);
  }
  return c->n > 1 && hi > 0 && hi - lo <= LEVEL * hi;
}

static int top_point(const curve *c) {
  int top = 0;
  for (int i = 1; i < c->n; i++)
    if (c->a[i] > c->a[top]) top = i;
  return top;
}

/* Index of the largest value if it is at an end, within LEVEL; else -1. */
static int edge_point(const curve *c, int top) {
  if (c->n == 0 || !(c->a[top] > 0) || is_closed(c)) return -1;
  double least = (1 - LEVEL) * c->a[top];
  if (c->a[0] >= least) return 0;
  if (is_interrupted(c, top) || is_interrupted(c, top - 1)) return top;
  if (c->a[top] == c->a[c->n - 1]) return top;
  return c->a[c->n - 1] >= least ? c->n - 1 : -1;
}

shb_status post_find_peaks(int n, const double *x, const double *amplitude, post_peak **peaks,
                           int *n_peaks) {
  curve c   = curve_of(n, x, amplitude);
  int   top = top_point(&c), edge = edge_point(&c, top), count = 0;
  *peaks   = NULL;
  *n_peaks = 0;
  for (int i = 0; i < n; i++) count += i == edge || is_maximum(&c, i, top);
  if (count == 0) return SHB_OK;
  post_peak *out = calloc((size_t)count, sizeof *out);
  SHB_CHECK(out, SHB_ERR_IO, "not enough memory for %d peaks", count);
  for (int i = 0, p = 0; i < n; i++) {
    if (i != edge && !is_maximum(&c, i, top)) continue;
    out[p].point = i;
    out[p].edge  = i == edge;
    if (i == edge) {
      out[p].at        = x[i];
      out[p].amplitude = amplitude[i];
      out[p].level     = is_level(&c);
      out[p].bandwidth = out[p].damping = NAN;
    } else {
      refine_peak(&c, i, &out[p]);
      measure_bandwidth(&c, &out[p]);
    }
    p++;
  }
  *peaks   = out;
  *n_peaks = count;
  return SHB_OK;
}

/* Scale of differences in x. */
static double size_at(const curve *c, int i) {
  return fmax(fabs(c->x[i]), 1e-2 * c->x_span);
}

static bool is_same(const curve *c, int i, int j) {
  return fabs(c->x[j] - c->x[i]) <= ROUNDING * size_at(c, i);
}

/* Direction in which x leaves point i in direction step; 0 at the end of the curve or of the
 * range. */
static int leaving(const curve *c, int i, int step) {
  for (int j = i + step; j >= 0 && j < c->n && !is_interrupted_to(c, j, -step); j += step)
    if (!is_same(c, i, j)) return c->x[j] > c->x[i] ? 1 : -1;
  return 0;
}

/* +1 if x is a maximum at i, -1 if a minimum, else 0. */
static int sense(const curve *c, int i) {
  int before = leaving(c, i, -1), after = leaving(c, i, 1);
  return before == after ? -before : 0;
}

/* The same; in a run of equal values only the first counts. */
static int turning(const curve *c, int i) {
  return i <= 0 || i >= c->n - 1 || is_same(c, i, i - 1) ? 0 : sense(c, i);
}

static void refine_fold(const curve *c, int i, post_fold *fold) {
  double s[3];
  fold->at        = c->x[i];
  fold->amplitude = c->a[i];
  if (!parabola_abscissa(c, i, c->a, s)) return;
  double at       = vertex(s, c->x + i - 1);
  fold->at        = parabola(s, c->x + i - 1, at);
  fold->amplitude = parabola(s, c->a + i - 1, at);
}

/* True for a flagged point at which x does not turn: rounding moved the turn to a neighbour. */
static bool turn_moved(const curve *c, const int *special, int i) {
  return special[i] == 1 && sense(c, i) == 0;
}

/* True for a flagged point, or a turning point that does not belong to a flagged neighbour. */
static bool is_fold(const curve *c, const int *special, int i) {
  if (special && special[i] == 1) return true;
  if (!turning(c, i)) return false;
  return !special || !(turn_moved(c, special, i - 1) || turn_moved(c, special, i + 1));
}

static post_fold fold_at(const curve *c, int i) {
  post_fold fold = {c->x[i], c->a[i], i, false};
  int       turn = sense(c, i);
  for (int j = i - 1; turn == 0 && j <= i + 1; j += 2) turn = turning(c, j);
  fold.upper = turn > 0;
  return fold;
}

/* Drop neighbouring pairs too close for a visible jump; returns the number left. */
static int drop_close_folds(const curve *c, post_fold *fold, int n) {
  int kept = 0;
  for (int i = 0; i < n; i++) {
    double before = kept ? fold[kept - 1].at : INFINITY;
    double size   = fmax(fabs(fold[i].at), 1e-2 * c->x_span);
    if (fabs(fold[i].at - before) < LEAST_FOLD_GAP * size) {
      kept--;
    } else {
      fold[kept++] = fold[i];
    }
  }
  return kept;
}

shb_status post_find_folds(int n, const double *x, const double *amplitude, const int *special,
                           post_fold **folds, int *n_folds) {
  curve c     = curve_of(n, x, amplitude);
  int   count = 0;
  *folds      = NULL;
  *n_folds    = 0;
  for (int i = 0; i < n; i++) count += is_fold(&c, special, i);
  if (count == 0) return SHB_OK;
  post_fold *out = calloc((size_t)count, sizeof *out);
  SHB_CHECK(out, SHB_ERR_IO, "not enough memory for %d folds", count);
  for (int i = 0, p = 0; i < n; i++)
    if (is_fold(&c, special, i)) out[p++] = fold_at(&c, i);
  /* before refinement, which would separate the two turns of a ripple */
  count = drop_close_folds(&c, out, count);
  for (int i = 0; i < count; i++)
    if (!special || special[out[i].point] != 1) refine_fold(&c, out[i].point, &out[i]);
  *folds   = out;
  *n_folds = drop_close_folds(&c, out, count);
  return SHB_OK;
}

int post_highest_peak(int n_peaks, const post_peak *peaks) {
  int best = n_peaks > 0 ? 0 : -1;
  for (int i = 1; i < n_peaks; i++)
    if (peaks[i].amplitude > peaks[best].amplitude) best = i;
  return best;
}
