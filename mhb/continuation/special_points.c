#include "mhb/continuation/special_points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/continuation/corrector.h"
#include "mhb/continuation/event_location.h"
#include "mhb/continuation/outputs.h"
#include "mhb/response/response.h"

/* Locating ends at 1e-9 of the chord or 1e-10 of the value, and 3e-8 beside a kink: nearer than this is the same place. */
static const double SAME_PLACE = 1e-8, SAME_VALUE = 1e-7, SAME_PART = 1e-3;

/* Of the value: folds nearer than this are not marked. */
static const double VISIBLE = 1e-5;

shb_status mhb_special_points_create(mhb_special_points *l, int most_unknowns) {
  *l   = (mhb_special_points){0};
  l->x = calloc((size_t)most_unknowns * MHB_MAX_SPECIAL_POINTS, sizeof(double));
  SHB_CHECK(l->x, SHB_ERR_IO, "out of memory");
  return SHB_OK;
}

void mhb_special_points_destroy(mhb_special_points *l) {
  free(l->x);
  *l = (mhb_special_points){0};
}

static double fold_indicator(const mhb_arclength *path, const mhb_curve_point *point,
                             void *context) {
  (void)context;
  return point->tangent[path->n];
}

static double peak_indicator(const mhb_arclength *path, const mhb_curve_point *point,
                             void *context) {
  return mhb_output_slope(path, point, *(const int *)context);
}

/* Locate the sign change from lo to hi; nothing is added if that fails. */
static bool add(mhb_special_points *l, mhb_arclength *path, mhb_special_point mark, double lo,
                double hi) {
  const mhb_curve_point *probe = &path->probe;
  bool                   fold  = mark.special == MHB_FOLD;
  if (!mhb_arclength_locate(path, fold ? fold_indicator : peak_indicator, &mark.output, lo, hi,
                            &mark.place))
    return false;
  mark.value      = probe->value;
  mark.residual   = probe->residual;
  mark.iterations = probe->iterations;
  memcpy(l->x + (size_t)l->n * (size_t)path->n, probe->x, sizeof(double) * (size_t)path->n);
  l->slot[l->n]   = l->n;
  l->mark[l->n++] = mark;
  return true;
}

static void sort(mhb_special_points *l) {
  for (int i = 1; i < l->n; i++)
    for (int j = i; j > 0 && l->mark[j - 1].place > l->mark[j].place; j--) {
      mhb_special_point mark = l->mark[j];
      int               slot = l->slot[j];
      l->mark[j]             = l->mark[j - 1];
      l->slot[j]             = l->slot[j - 1];
      l->mark[j - 1]         = mark;
      l->slot[j - 1]         = slot;
    }
}

static bool coincide(const mhb_special_point *a, const mhb_special_point *b) {
  double apart = fabs(b->place - a->place);
  return apart < SAME_PLACE ||
         (apart < SAME_PART && fabs(b->value - a->value) < SAME_VALUE * fabs(a->value));
}

/* Of those at one place one is kept: the fold, if one is. */
static void merge(mhb_special_points *l) {
  int kept = 0;
  for (int i = 0; i < l->n; i++) {
    if (kept > 0 && coincide(&l->mark[kept - 1], &l->mark[i])) {
      if (l->mark[i].special != MHB_FOLD) continue;
      kept--;
    }
    l->mark[kept]   = l->mark[i];
    l->slot[kept++] = l->slot[i];
  }
  l->n = kept;
}

void mhb_special_points_find(mhb_special_points *l, mhb_arclength *path, int n_outputs,
                             const double *before, const double *after) {
  double a = path->now.tangent[path->n], b = path->next.tangent[path->n];
  l->n        = 0;
  l->away     = a * b < 0;
  l->unmarked = l->away && !add(l, path, (mhb_special_point){.special = MHB_FOLD}, a, b);
  for (int o = 0; o < n_outputs && l->n < MHB_MAX_SPECIAL_POINTS; o++) {
    if (!(before[o] > 0 && after[o] < 0)) continue;
    l->away = true;
    add(l, path, (mhb_special_point){.special = MHB_PEAK, .output = o}, before[o], after[o]);
  }
  sort(l);
  merge(l);
}

bool mhb_special_points_miss_fold(const mhb_special_points *l, const mhb_arclength *path) {
  double value = path->now.value, way = path->now.tangent[path->n];
  for (int i = 0; i <= l->n; i++) {
    double to = i < l->n ? l->mark[i].value : path->next.value;
    if (copysign(1, way) * (to - value) < -VISIBLE * mhb_arclength_size(path)) return true;
    if (i < l->n && l->mark[i].special == MHB_FOLD) way = -way;
    value = to;
  }
  return false;
}

void mhb_special_points_visit(const mhb_special_points *l, mhb_arclength *path, int i) {
  const mhb_special_point *mark  = &l->mark[i];
  mhb_curve_point         *probe = &path->probe;
  memcpy(probe->x, l->x + (size_t)l->slot[i] * (size_t)path->n, sizeof(double) * (size_t)path->n);
  probe->value      = mark->value;
  probe->residual   = mark->residual;
  probe->iterations = mark->iterations;
  mhb_balance_linearise(path->residual, probe->x, probe->value, path->newton->r, NULL);
}
