#include "mhb/continuation/closed_curve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* Closure is tested only if the chord passes the place within so many step lengths. */
static const double NEAR_CHORD = 0.3;

void mhb_curve_place_free(mhb_curve_place *place) {
  free(place->x);
  free(place->tangent);
  *place = (mhb_curve_place){0};
}

void mhb_curve_place_note(mhb_curve_place *place, const mhb_curve_system *s,
                          const mhb_curve_point *point, double tolerance) {
  int    copies = s->copies > 1 ? s->copies : 1;
  size_t n      = (size_t)s->n;
  double size   = mhb_norm(point->x, s->n);
  mhb_curve_place_free(place);
  *place = (mhb_curve_place){.rows       = s->n / s->row_length,
                             .row_length = s->row_length,
                             .copies     = copies,
                             .x          = shb_alloc_zeroed(n * (size_t)copies, sizeof(double)),
                             .tangent    = shb_alloc_zeroed(n * (size_t)copies, sizeof(double)),
                             .value      = point->value,
                             .rate       = point->tangent[s->n],
                             .size       = size > 0 ? size : 1,
                             .tolerance  = tolerance};
  memcpy(place->x, point->x, sizeof(double) * n);
  memcpy(place->tangent, point->tangent, sizeof(double) * n);
  for (int j = 1; j < copies; j++) {
    s->copy(s, point->x, j, place->x + (size_t)j * n);
    s->copy(s, point->tangent, j, place->tangent + (size_t)j * n);
  }
}

void mhb_curve_place_turn(mhb_curve_place *place) {
  int n = place->copies * place->rows * place->row_length;
  for (int i = 0; i < n; i++) place->tangent[i] = -place->tangent[i];
  place->rate = -place->rate;
}

/* Index of the unknown i in the place's arrays. The system may have another number of harmonics.
 * -1: the place has no such harmonic, which is 0 there. */
static long index_in(const mhb_curve_return *at, const mhb_curve_system *s, int i) {
  const mhb_curve_place *p   = at->place;
  int                    row = i / s->row_length, k = i % s->row_length;
  return k < p->row_length ? ((long)at->copy * p->rows + row) * p->row_length + k : -1;
}

double mhb_curve_return_ahead(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  const mhb_curve_return *at    = context;
  const mhb_curve_place  *p     = at->place;
  double                  scale = curve->parameter_scale;
  double                  sum   = p->rate * (point->value - p->value) / (scale * scale);
  for (int i = 0; i < curve->n; i++) {
    long k = index_in(at, curve->system, i);
    if (k >= 0) sum += p->tangent[k] * (point->x[i] - p->x[k]) / (p->size * p->size);
  }
  return sum;
}

static double unit_of(const mhb_arclength *curve) {
  double size = mhb_norm(curve->current.x, curve->n);
  return size > 0 ? size : 1;
}

/* Distance in y of from + part (to - from) from the copy. */
static double distance(const mhb_curve_return *at, const mhb_arclength *curve,
                       const mhb_curve_point *from, const mhb_curve_point *to, double part) {
  const mhb_curve_place *p     = at->place;
  double                 unit  = unit_of(curve);
  double                 value = from->value + part * (to->value - from->value);
  double                 sum   = pow((value - p->value) / curve->parameter_scale, 2);
  for (int i = 0; i < curve->n; i++) {
    long   k = index_in(at, curve->system, i);
    double x = from->x[i] + part * (to->x[i] - from->x[i]);
    sum += pow((x - (k >= 0 ? p->x[k] : 0)) / unit, 2);
  }
  return sqrt(sum);
}

double mhb_curve_place_distance(const mhb_curve_place *place, const mhb_arclength *curve,
                                const mhb_curve_point *point) {
  double least = INFINITY;
  for (int j = 0; j < place->copies; j++) {
    mhb_curve_return at = {place, j};
    least               = fmin(least, distance(&at, curve, point, point, 0));
  }
  return least;
}

bool mhb_curve_return_repeats(const mhb_curve_return *at) {
  const mhb_curve_place *p   = at->place;
  int                    n   = p->rows * p->row_length;
  const double          *x   = p->x + (size_t)at->copy * (size_t)n;
  double                 sum = 0;
  for (int i = 0; at->copy > 0 && i < n; i++) sum += pow((x[i] - p->x[i]) / p->size, 2);
  return at->copy > 0 && sqrt(sum) <= p->tolerance;
}

bool mhb_curve_return_is_near(mhb_arclength *curve, double at_current, double at_next,
                              void *context) {
  const mhb_curve_point *from = &curve->current, *to = &curve->next;
  double                 unit = unit_of(curve), part = at_current / (at_current - at_next);
  double                 sum = pow((to->value - from->value) / curve->parameter_scale, 2);
  for (int i = 0; i < curve->n; i++) sum += pow((to->x[i] - from->x[i]) / unit, 2);
  return distance(context, curve, from, to, part) <= NEAR_CHORD * sqrt(sum);
}

bool mhb_curve_return_arrived(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  const mhb_curve_return *at = context;
  return distance(at, curve, point, point, 0) <= at->place->tolerance;
}
