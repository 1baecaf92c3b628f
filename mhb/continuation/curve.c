#include "mhb/continuation/curve.h"

#include <stdlib.h>

/* In y; tuned as the constants of step control (arclength.c). */
static const double LONGEST_STEP = 0.1;

shb_status mhb_curve_point_create(mhb_curve_system *system, mhb_curve_point *point) {
  size_t n          = (size_t)system->n;
  *point            = (mhb_curve_point){0};
  point->x          = calloc(n, sizeof(double));
  point->tangent    = calloc(n + 1, sizeof(double));
  point->r          = calloc(n, sizeof(double));
  point->slope      = calloc(n, sizeof(double));
  shb_status status = SHB_OK;
  if (!(point->x && point->tangent && point->r && point->slope))
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory for a point of a curve");
  if (status == SHB_OK && system->evaluation_create)
    status = system->evaluation_create(system, &point->evaluation);
  if (status != SHB_OK) mhb_curve_point_destroy(system, point);
  return status;
}

void mhb_curve_point_destroy(mhb_curve_system *system, mhb_curve_point *point) {
  if (point->evaluation) system->evaluation_destroy(system, point->evaluation);
  free(point->x);
  free(point->tangent);
  free(point->r);
  free(point->slope);
  *point = (mhb_curve_point){0};
}

static shb_status fill(mhb_arclength *curve) {
  size_t one            = (size_t)curve->n + 1;
  curve->chord          = calloc(one, sizeof(double));
  curve->former_tangent = calloc(one, sizeof(double));
  curve->column         = calloc(one, sizeof(double));
  curve->row            = calloc(one, sizeof(double));
  curve->delta          = calloc(one, sizeof(double));
  SHB_CHECK(curve->chord && curve->former_tangent && curve->column && curve->row && curve->delta,
            SHB_ERR_IO, "out of memory for a curve of %d unknowns", curve->n);
  SHB_TRY(mhb_curve_point_create(curve->system, &curve->current));
  SHB_TRY(mhb_curve_point_create(curve->system, &curve->next));
  for (int i = 0; i < 3; i++) SHB_TRY(mhb_curve_point_create(curve->system, &curve->bracket[i]));
  return mhb_curve_point_create(curve->system, &curve->trial);
}

shb_status mhb_arclength_create(mhb_curve_system *system, double low, double high,
                                mhb_arclength **out) {
  mhb_arclength *curve = calloc(1, sizeof *curve);
  if (!curve) system->destroy(system);
  SHB_CHECK(curve, SHB_ERR_IO, "out of memory");
  curve->system            = system;
  curve->n                 = system->n;
  curve->low               = low;
  curve->high              = high;
  curve->parameter_scale   = high - low;
  curve->amplitude_at_rest = 1;
  curve->longest           = LONGEST_STEP;
  curve->tolerance         = 1e-10;
  curve->roundoff_level    = 1e-8;
  shb_status status        = fill(curve);
  if (status != SHB_OK) {
    mhb_arclength_destroy(curve);
    return status;
  }
  *out = curve;
  return SHB_OK;
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
