#include "cases/study/line_minimum.h"

#include <math.h>
#include <stdlib.h>

/* Points at first. A peak over a parameter has few minima; each start of a search has its own part
 * of the range. */
enum { FIRST_POINTS = 5, MOST_STEPS = 40 };
/* Distance of the second value where the slope is not known, in parts of the range. */
static const double DIFFERENCE = 1e-4;
/* Values of both ends that differ by less than this part from what the slopes allow are equal. */
static const double EQUAL = 1e-10;

/* A point this near to an end of its bracket, in parts of it, says nothing new about the models. */
static const double NEAR = 1e-3;

typedef struct {
  double u, value, slope;
  double curvature; /* from the slope of the point before on the same side; 0: not known */
} line_point;

typedef struct {
  line_function *function;
  void          *context;
  double         low, high, width, least;
  bool           ended;
} line_search;

typedef enum { SMOOTH, KINK } line_model;

static bool is_known(const line_point *p) {
  return isfinite(p->value) && isfinite(p->slope);
}

/* Value and slope at u; a slope that is not known comes from a second value. */
static line_point evaluate(line_search *s, double u) {
  line_point p = {u, INFINITY, NAN, 0};
  s->ended     = s->ended || !s->function(s->context, u, &p.value, &p.slope);
  if (!s->ended && isfinite(p.value) && isnan(p.slope)) {
    double at = DIFFERENCE * (s->high - s->low), other = INFINITY, unused;
    if (u + at > s->high) at = -at;
    s->ended = !s->function(s->context, u + at, &other, &unused);
    p.slope  = isfinite(other) ? (other - p.value) / at : NAN;
  }
  if (isfinite(p.value)) s->least = fmin(s->least, p.value);
  return p;
}

/* ---------------------------------------------------------------- models between two points */

/* Where the cubic through both values and slopes is least; its value. */
static double cubic_minimum(const line_point *l, const line_point *r, double *value) {
  const double h = r->u - l->u, rise = (r->value - l->value) / h;
  const double z = l->slope + r->slope - 3 * rise, q = sqrt(fmax(0, z * z - l->slope * r->slope));
  const double t = 1 - (r->slope + q - z) / (r->slope - l->slope + 2 * q);
  const double b = 3 * rise - 2 * l->slope - r->slope, a = l->slope + r->slope - 2 * rise;
  *value = l->value + h * t * (l->slope + t * (b + t * a));
  return l->u + t * h;
}

/* The parabola of one end at u. */
static double side_at(const line_point *p, double u) {
  return p->value + (u - p->u) * (p->slope + 0.5 * p->curvature * (u - p->u));
}

/* Where the parabolas of both ends meet, by Newton's method from where the tangents do. */
static double kink(const line_point *l, const line_point *r, double *value) {
  const double h = r->u - l->u;
  double       u = l->u + (r->value - l->value - r->slope * h) / (l->slope - r->slope);
  for (int i = 0; i < 4; i++) {
    double steep = l->slope + l->curvature * (u - l->u) - r->slope - r->curvature * (u - r->u);
    u -= (side_at(l, u) - side_at(r, u)) / steep;
  }
  *value = side_at(l, u);
  return u;
}

/* The cubic at u. */
static double cubic_at(const line_point *l, const line_point *r, double u) {
  const double h = r->u - l->u, t = (u - l->u) / h, rise = (r->value - l->value) / h;
  const double b = 3 * rise - 2 * l->slope - r->slope, a = l->slope + r->slope - 2 * rise;
  return l->value + h * t * (l->slope + t * (b + t * a));
}

static double sides_at(const line_point *l, const line_point *r, double u) {
  return fmax(side_at(l, u), side_at(r, u));
}

/* The least value that one of the models promises. */
static double promise(const line_point *l, const line_point *r) {
  double smooth, sharp;
  cubic_minimum(l, r, &smooth);
  kink(l, r, &sharp);
  return fmin(smooth, sharp);
}

/* ---------------------------------------------------------------- one bracket */

/* The next point of a bracket. Of a kink the parabola of the far end keeps its error. Points may
 * then come from one side only. So the third and fourth go further, and one beside an end too.
 * After more, and where the model has no place between the ends, the bracket is halved.
 *   side  in  -n, n: the last n points became the left, the right end */
static double next_place(const line_search *s, const line_point *l, const line_point *r,
                         line_model model, int side) {
  static const double further[] = {0.01, 0.01, 0.03, 0.2}; /* parts of the bracket */
  const double        h         = r->u - l->u;
  const int           count     = abs(side);
  double value, at = model == SMOOTH ? cubic_minimum(l, r, &value) : kink(l, r, &value);
  double from_left = at - l->u, from_right = r->u - at;
  if (!(fmin(from_left, from_right) > -0.1 * h) || count >= 4) return l->u + 0.5 * h;
  const bool   left       = count < 2 ? from_left < from_right : side < 0;
  const double model_step = left ? from_left : from_right,
               least      = fmin(fmax(further[count] * h, 0.3 * s->width), 0.5 * h);
  double step             = count < 2 ? model_step : fmin(10 * model_step, 0.5 * h);
  if (count >= 2 || model_step < NEAR * h) step = fmax(step, least);
  return left ? l->u + step : r->u - step;
}

/* The curvature at a point from the one that it follows, both on one side. Slopes of points that
 * are closer than a part of the bracket differ by their errors. */
static void set_curvature(line_point *p, const line_point *before, double bracket) {
  const double step = p->u - before->u;
  p->curvature =
      fabs(step) < NEAR * bracket ? before->curvature : (p->slope - before->slope) / step;
}

/* Close the bracket l, r, where the slope changes from - to +. */
static void close_bracket(line_search *s, line_point l, line_point r) {
  line_model model = SMOOTH;
  int        side  = 0;
  for (int i = 0; i < MOST_STEPS && !s->ended && r.u - l.u > s->width; i++) {
    const double h  = r.u - l.u;
    const double at = next_place(s, &l, &r, model, side);
    line_point   p  = evaluate(s, at);
    if (!is_known(&p)) return;
    double kinked = fabs(p.value - sides_at(&l, &r, at)),
           smooth = fabs(p.value - cubic_at(&l, &r, at));
    /* Beside an end both foretell the value. */
    if (fmin(at - l.u, r.u - at) > NEAR * h) model = kinked < smooth ? KINK : SMOOTH;
    /* A flat point of a smooth minimum: what is left to gain is below the rounding of values. */
    if (model == SMOOTH && fabs(p.slope) * h < EQUAL * fabs(p.value)) return;
    int now         = p.slope < 0 ? -1 : 1;
    side            = now * side > 0 ? side + now : now;
    line_point *end = now < 0 ? &l : &r;
    set_curvature(&p, end, h);
    *end = p;
  }
}

/* ---------------------------------------------------------------- the whole range */

static bool is_bracket(const line_point *l, const line_point *r) {
  return is_known(l) && is_known(r) && l->slope < 0 && r->slope > 0;
}

/* Whether a least value lies between points whose slopes do not show it: the value falls where both
 * slopes rise, or rises where both fall. */
static bool hides_minimum(const line_point *l, const line_point *r) {
  if (!is_known(l) || !is_known(r) || l->slope * r->slope < 0) return false;
  return (r->value - l->value) * (l->slope + r->slope) < 0;
}

/* Points at even distances, and half-way between those that hide a minimum. Returns how many. */
static int first_points(line_search *s, line_point *point) {
  int n = 0;
  for (int i = 0; i < FIRST_POINTS && !s->ended; i++) {
    const double step = (s->high - s->low) / (FIRST_POINTS - 1);
    line_point   next = evaluate(s, i == FIRST_POINTS - 1 ? s->high : s->low + i * step);
    if (i > 0 && !s->ended && hides_minimum(&point[n - 1], &next)) {
      point[n] = evaluate(s, 0.5 * (point[n - 1].u + next.u));
      n++;
    }
    point[n++] = next;
  }
  return n;
}

void line_minimum(double low, double high, double width, line_function *function, void *context) {
  line_search s = {function, context, low, high, width, INFINITY, false};
  line_point  point[2 * FIRST_POINTS];
  bool        closed[2 * FIRST_POINTS] = {false};
  const int   n                        = first_points(&s, point);
  for (int best = 0; best >= 0 && !s.ended;) {
    double most = s.least;
    best        = -1;
    for (int i = 0; i + 1 < n; i++) {
      const line_point *l = &point[i], *r = &point[i + 1];
      if (closed[i] || !is_bracket(l, r) || promise(l, r) >= most) continue;
      best = i;
      most = promise(l, r);
    }
    if (best < 0) return;
    closed[best] = true;
    if (best > 0 && is_known(&point[best - 1])) set_curvature(&point[best], &point[best - 1], 0);
    if (best + 2 < n && is_known(&point[best + 2]))
      set_curvature(&point[best + 1], &point[best + 2], 0);
    close_bracket(&s, point[best], point[best + 1]);
  }
}
