#include "mhb/continuation/closed_curve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/balance/subharmonics.h"
#include "mhb/continuation/event_location.h"

/* Of a step: how far off the beginning it may pass for a closer look. */
static const double WORTH_A_LOOK = .3;

/* Of the motion: what is left of the part of higher order where the curve joins another. */
static const double VANISHED = 2e-3;

/* What is measured of a point: its place in y along and off the direction in which the curve began. */
typedef struct {
  const mhb_curve_start *curve;
  int                    shift;
  double                 scale; /* m */
} view;

void mhb_curve_start_free(mhb_curve_start *c) {
  free(c->x);
  free(c->tangent);
  *c = (mhb_curve_start){0};
}

shb_status mhb_curve_start_begin(mhb_curve_start *c, const mhb_arclength *path, double tolerance) {
  const mhb_balance     *b    = path->residual;
  const mhb_curve_point *now  = &path->now;
  size_t                 size = (size_t)b->n * (size_t)b->receptance->nu;
  *c                          = (mhb_curve_start){.rows      = 3 * b->n_pairs,
                                                  .m         = b->m,
                                                  .order     = b->receptance->nu,
                                                  .x         = calloc(size, sizeof(double)),
                                                  .tangent   = calloc(size, sizeof(double)),
                                                  .value     = now->value,
                                                  .rise      = now->tangent[path->n],
                                                  .tolerance = tolerance};
  if (!c->x || !c->tangent) {
    mhb_curve_start_free(c);
    SHB_FAIL(SHB_ERR_IO, "out of memory");
  }
  for (int j = 0; j < c->order; j++) {
    mhb_subharmonic_shift(b, now->x, j, c->x + j * b->n);
    mhb_subharmonic_shift(b, now->tangent, j, c->tangent + j * b->n);
  }
  return SHB_OK;
}

/* Where the beginning's coefficient i of a row of m harmonics is kept; -1: it has none. */
static long kept_at(const view *v, int nb, int i) {
  int wide = 2 * v->curve->m + 1, row = i / nb, k = i % nb;
  return k < wide ? ((long)v->shift * v->curve->rows + row) * wide + k : -1;
}

/* (x, value) - beginning along the direction in which it was left. */
static double ahead(const view *v, const mhb_arclength *path, const mhb_curve_point *point) {
  const mhb_curve_start *c   = v->curve;
  double                 sum = c->rise * (point->value - c->value) / (path->span * path->span);
  for (int i = 0; i < path->n; i++) {
    long at = kept_at(v, path->residual->nb, i);
    if (at >= 0) sum += c->tangent[at] * (point->x[i] - c->x[at]) / (v->scale * v->scale);
  }
  return sum;
}

/* Distance of now + part (next - now) from the beginning. */
static double off(const view *v, const mhb_arclength *path, const mhb_curve_point *now,
                  const mhb_curve_point *next, double part) {
  const mhb_curve_start *c     = v->curve;
  double                 value = now->value + part * (next->value - now->value);
  double                 sum   = pow((value - c->value) / path->span, 2);
  for (int i = 0; i < path->n; i++) {
    long   at = kept_at(v, path->residual->nb, i);
    double x  = now->x[i] + part * (next->x[i] - now->x[i]);
    sum += pow((x - (at >= 0 ? c->x[at] : 0)) / v->scale, 2);
  }
  return sqrt(sum);
}

void mhb_curve_start_turn(mhb_curve_start *c) {
  int n = c->order * c->rows * (2 * c->m + 1);
  for (int i = 0; i < n; i++) c->tangent[i] = -c->tangent[i];
  c->rise = -c->rise;
}

static double size_of_motion(const mhb_arclength *path) {
  double size = mhb_norm(path->now.x, path->n);
  return size > 0 ? size : 1;
}

double mhb_curve_start_distance(const mhb_curve_start *c, const mhb_arclength *path,
                                const mhb_curve_point *point) {
  double least = INFINITY;
  for (int j = 0; j < c->order; j++) {
    view v = {c, j, size_of_motion(path)};
    least  = fmin(least, off(&v, path, point, point, 0));
  }
  return least;
}

static double length(const mhb_arclength *path, double scale) {
  double sum = pow((path->next.value - path->now.value) / path->span, 2);
  for (int i = 0; i < path->n; i++) sum += pow((path->next.x[i] - path->now.x[i]) / scale, 2);
  return sqrt(sum);
}

static double ahead_indicator(const mhb_arclength *path, const mhb_curve_point *point,
                              void *context) {
  return ahead(context, path, point);
}

static void copy_point(const mhb_arclength *path, const mhb_curve_point *from,
                       mhb_curve_point *to) {
  double *x = to->x, *tangent = to->tangent;
  memcpy(x, from->x, sizeof(double) * (size_t)path->n);
  memcpy(tangent, from->tangent, sizeof(double) * ((size_t)path->n + 1));
  *to         = *from;
  to->x       = x;
  to->tangent = tangent;
}

static int passes(view *v, mhb_arclength *path) {
  double from = ahead(v, path, &path->now), to = ahead(v, path, &path->next), at;
  if (!(from < 0 && to >= 0)) return 0;
  double step = length(path, v->scale), part = from / (from - to);
  if (off(v, path, &path->now, &path->next, part) > WORTH_A_LOOK * step) return 0;
  int found = mhb_arclength_locate(path, ahead_indicator, v, from, to, &at) &&
              off(v, path, &path->probe, &path->probe, 0) <= v->curve->tolerance;
  if (found) copy_point(path, &path->probe, &path->next);
  mhb_balance_linearise(path->residual, path->next.x, path->next.value, path->newton->r, NULL);
  return found;
}

int mhb_curve_start_passes(mhb_curve_start *c, mhb_arclength *path) {
  for (int j = 0; j < c->order; j++) {
    view v = {c, j, size_of_motion(path)};
    if (passes(&v, path)) return 1;
  }
  return 0;
}

/* The part's size |z| falls by z.dz/|z| a unit of arclength. */
static int part_vanishes(mhb_arclength *path, int d) {
  const mhb_balance *b = path->residual;
  double             z[b->n], dz[b->n], slope = 0;
  mhb_subharmonic_component(b, path->now.x, d, z);
  mhb_subharmonic_component(b, path->now.tangent, d, dz);
  double size = mhb_norm(z, b->n);
  for (int i = 0; i < b->n && size > 0; i++) slope += z[i] * dz[i] / size;
  if (!(slope < 0)) return 0;
  if (size < VANISHED * mhb_norm(path->now.x, b->n)) return 1;
  double left = size / -slope;
  if (left < 2 * path->step) path->step = .5 * left;
  return 0;
}

int mhb_subharmonic_part_vanishes(mhb_arclength *path) {
  int nu = path->residual->receptance->nu;
  for (int d = 1; d < nu; d++)
    if (nu % d == 0 && part_vanishes(path, d)) return 1;
  return 0;
}
