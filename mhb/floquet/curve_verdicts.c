#include "mhb/floquet/curve_verdicts.h"

#include <math.h>

static const double STEEPER = 2;

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

/* Whether the points between first and last have their kind. */
static bool is_decided(const mhb_curve_verdict *v, const neighbours *at) {
  double steepest = fmax(slope(v, at->first, at->last),
                         fmax(slope(v, at->before, at->first), slope(v, at->last, at->after)));
  return same_kind(v, at) && STEEPER * steepest * (at->last - at->first) <
                                 fabs(v[at->first].excess) + fabs(v[at->last].excess);
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

int mhb_curve_verdicts_next(int n, const mhb_curve_verdict *v) {
  int longest[2] = {1, 1}, middle[2] = {-1, -1}; /* between different kinds; undecided pairs */
  for (int i = 0; i < n; i++)
    if (is_open(&v[i]) && v[i].wanted) return i;
  for (int i = 0; i < n; i++)
    if (is_open(&v[i]) && is_end(n, v, i)) return i;
  for (int i = 0; i < n; i++) {
    neighbours at = pair_from(n, v, i);
    if (at.last < 0 || is_decided(v, &at)) continue;
    int which = same_kind(v, &at);
    if (at.last - i <= longest[which]) continue;
    longest[which] = at.last - i;
    middle[which]  = i + (at.last - i) / 2;
  }
  return middle[0] >= 0 ? middle[0] : middle[1];
}

void mhb_curve_verdicts_decided(int n, const mhb_curve_verdict *v, int *decided) {
  for (int i = 0; i < n; i++) decided[i] = -1;
  for (int i = 0; i < n; i++) {
    neighbours at = pair_from(n, v, i);
    if (at.last < 0 || !is_decided(v, &at)) continue;
    for (int k = i + 1; k < at.last; k++) decided[k] = i;
  }
}
