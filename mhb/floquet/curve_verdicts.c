#include "mhb/floquet/curve_verdicts.h"

#include <math.h>

static const double STEEPER = 2;
enum { FARTHEST = 8 }; /* points from first to last: an excursion may begin and end between */

/* Judged points of a stretch around a pair, and what is between. */
typedef struct {
  int before, first, last, after; /* -1: none */
} neighbours;

static bool is_open(const mhb_curve_verdict *v) {
  return !v->judged && !v->undecided && !v->divides;
}

static bool ends_at(const mhb_curve_verdict *v) {
  return v->divides || v->undecided;
}

/* The next judged point of the same stretch in direction step; -1: none. */
static int judged_beside(int n, const mhb_curve_verdict *v, int point, int step) {
  for (int i = point + step; i >= 0 && i < n; i += step) {
    if (v[step > 0 ? i : i + 1].begins || ends_at(&v[i])) return -1;
    if (v[i].judged) return i;
  }
  return -1;
}

static double slope(const mhb_curve_verdict *v, int a, int b) {
  return a < 0 || b < 0 ? 0 : fabs(v[b].excess - v[a].excess) / (b - a);
}

static bool same_kind(const mhb_curve_verdict *v, const neighbours *at) {
  return v[at->first].kind == v[at->last].kind;
}

/* L (j - i)/(|f_i| + |f_j|) */
static double doubt(const mhb_curve_verdict *v, const neighbours *at) {
  double steepest = fmax(slope(v, at->first, at->last),
                         fmax(slope(v, at->before, at->first), slope(v, at->last, at->after)));
  double sum      = fabs(v[at->first].excess) + fabs(v[at->last].excess);
  return STEEPER * steepest * (at->last - at->first) / fmax(sum, 1e-12);
}

/* Whether the points between first and last have their kind. */
static bool is_decided(const mhb_curve_verdict *v, const neighbours *at) {
  return same_kind(v, at) && at->last - at->first <= FARTHEST && doubt(v, at) < 1;
}

/* The pair that begins at a judged point; last is -1 if there is none. */
static neighbours pair_from(int n, const mhb_curve_verdict *v, int first) {
  neighbours at = {-1, first, -1, -1};
  if (!v[first].judged || ends_at(&v[first])) return at;
  at.before = judged_beside(n, v, first, -1);
  at.last   = judged_beside(n, v, first, 1);
  if (at.last >= 0) at.after = judged_beside(n, v, at.last, 1);
  return at;
}

/* First or last point of a stretch. */
static bool is_end(int n, const mhb_curve_verdict *v, int i) {
  return i == 0 || i == n - 1 || v[i].begins || v[i + 1].begins || ends_at(&v[i - 1]) ||
         ends_at(&v[i + 1]);
}

/* A wanted point that is not judged, or an end of a stretch; -1: none. */
static int first_points(int n, const mhb_curve_verdict *v) {
  for (int i = 0; i < n; i++)
    if (is_open(&v[i]) && v[i].wanted) return i;
  for (int i = 0; i < n; i++)
    if (is_open(&v[i]) && is_end(n, v, i)) return i;
  return -1;
}

int mhb_curve_verdicts_next(int n, const mhb_curve_verdict *v) {
  int    next = first_points(n, v), longest = 1, between = -1, middle = -1;
  double least = INFINITY;
  if (next >= 0) return next;
  for (int i = 0; i < n; i++) {
    neighbours at  = pair_from(n, v, i);
    int        gap = at.last - i;
    if (at.last < 0 || gap < 2 || is_decided(v, &at)) continue;
    if (!same_kind(v, &at) && gap > longest) {
      longest = gap;
      between = i + gap / 2;
    }
    if (same_kind(v, &at) && doubt(v, &at) < least) {
      least  = doubt(v, &at);
      middle = i + gap / 2;
    }
  }
  return between >= 0 ? between : middle;
}

void mhb_curve_verdicts_decided(int n, const mhb_curve_verdict *v, int *decided) {
  for (int i = 0; i < n; i++) decided[i] = -1;
  for (int i = 0; i < n; i++) {
    neighbours at = pair_from(n, v, i);
    if (at.last < 0 || !is_decided(v, &at)) continue;
    for (int k = i + 1; k < at.last; k++) decided[k] = i;
  }
}
