#include "mhb/continuation/curve.h"

#include <stdlib.h>

#include "mesh/base/memory.h"

/* In y; tuned as the constants of step control (arclength.c). */
static const double LONGEST_STEP = 0.1;

void mhb_curve_point_create(mhb_curve_system *system, mhb_curve_point *point) {
  size_t n       = (size_t)system->n;
  *point         = (mhb_curve_point){0};
  point->x       = shb_alloc_zeroed(n, sizeof(double));
  point->tangent = shb_alloc_zeroed(n + 1, sizeof(double));
  point->r       = shb_alloc_zeroed(n, sizeof(double));
  point->slope   = shb_alloc_zeroed(n, sizeof(double));
  if (system->evaluation_create) point->evaluation = system->evaluation_create(system);
}

void mhb_curve_point_destroy(mhb_curve_system *system, mhb_curve_point *point) {
  if (point->evaluation) system->evaluation_destroy(system, point->evaluation);
  free(point->x);
  free(point->tangent);
  free(point->r);
  free(point->slope);
  *point = (mhb_curve_point){0};
}

static void fill(mhb_arclength *curve) {
  size_t one            = (size_t)curve->n + 1;
  curve->chord          = shb_alloc_zeroed(one, sizeof(double));
  curve->former_tangent = shb_alloc_zeroed(one, sizeof(double));
  curve->column         = shb_alloc_zeroed(one, sizeof(double));
  curve->row            = shb_alloc_zeroed(one, sizeof(double));
  curve->delta          = shb_alloc_zeroed(one, sizeof(double));
  mhb_curve_point_create(curve->system, &curve->current);
  mhb_curve_point_create(curve->system, &curve->next);
  for (int i = 0; i < 3; i++) mhb_curve_point_create(curve->system, &curve->bracket[i]);
  mhb_curve_point_create(curve->system, &curve->trial);
}

mhb_arclength *mhb_arclength_create(mhb_curve_system *system, double low, double high) {
  mhb_arclength *curve     = shb_alloc_zeroed(1, sizeof *curve);
  curve->system            = system;
  curve->n                 = system->n;
  curve->low               = low;
  curve->high              = high;
  curve->parameter_scale   = high - low;
  curve->amplitude_at_rest = 1;
  curve->longest           = LONGEST_STEP;
  curve->tolerance         = 1e-10;
  curve->roundoff_level    = 1e-8;
  fill(curve);
  return curve;
}

void mhb_arclength_destroy(mhb_arclength *curve) {
  if (!curve) return;
  mhb_curve_point_destroy(curve->system, &curve->current);
  mhb_curve_point_destroy(curve->system, &curve->next);
  mhb_curve_point_destroy(curve->system, &curve->trial);
  for (int i = 0; i < 3; i++) mhb_curve_point_destroy(curve->system, &curve->bracket[i]);
  free(curve->chord);
  free(curve->former_tangent);
  free(curve->column);
  free(curve->row);
  free(curve->delta);
  curve->system->destroy(curve->system);
  free(curve);
}

void mhb_arclength_advance(mhb_arclength *curve) {
  mhb_curve_point old = curve->current;
  curve->current      = curve->next;
  curve->next         = old;
}
