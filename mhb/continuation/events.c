#include "mhb/continuation/events.h"

#include <math.h>

#include "mhb/continuation/corrector.h"

/* Events are located to 1e-9 of the chord or 1e-10 of the value (1e-8 where events are brief), and
 * to 3e-8 beside a kink. Nearer than this they are at the same place. */
static const double SAME_PLACE = 1e-8, SAME_VALUE = 1e-7, SAME_PART = 1e-3;

/* Relative to the value: folds nearer to each other than this are not searched for. */
static const double VISIBLE = 1e-5;

const char *mhb_end_text(mhb_end end) {
  static const char *const text[MHB_N_ENDS] = {
      [MHB_END_NONE]        = "under way",
      [MHB_END_HIGH]        = "end of range",
      [MHB_END_LOW]         = "turned back to the start of the range",
      [MHB_END_CLOSED]      = "closed curve",
      [MHB_END_JOINED]      = "joins a curve of lower order",
      [MHB_END_STALLED]     = "no step converged",
      [MHB_END_TINY_STEPS]  = "the steps stayed tiny",
      [MHB_END_TURNED]      = "the maximum ends",
      [MHB_END_CORNER]      = "slip ends",
      [MHB_END_SMOOTH]      = "the maximum leaves its kink",
      [MHB_END_MEETS_PLUS]  = "the pair of multipliers meets at +1",
      [MHB_END_MEETS_MINUS] = "the pair of multipliers meets at -1",
      [MHB_END_FREQUENCY]   = "leaves the frequency range",
      [MHB_END_HARMONICS]  = "no solution near by with as many harmonics as mhb.tolerance asks for",
      [MHB_END_MAX_POINTS] = "mhb.max_points reached",
      [MHB_END_NO_START]   = "no first solution",
      [MHB_END_INTERRUPTED] = "interrupted"};
  return text[end];
}

void mhb_events_destroy(mhb_events *events) {
  for (int i = 0; i < MHB_MAX_EVENTS && events->system; i++)
    mhb_curve_point_destroy(events->system, &events->point[i]);
  *events = (mhb_events){0};
}

void mhb_events_begin(mhb_arclength *curve, int n_tests, mhb_event_test *test) {
  for (int i = 0; i < n_tests; i++)
    test[i].value_current = test[i].g(curve, &curve->current, test[i].context);
}

void mhb_events_advance(int n_tests, mhb_event_test *test) {
  for (int i = 0; i < n_tests; i++) test[i].value_current = test[i].value_next;
}

static double beyond_high(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  (void)context;
  return point->value - curve->high;
}

static double beyond_low(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  (void)context;
  return curve->low - point->value;
}

void mhb_events_range_ends(mhb_event_test test[2]) {
  test[0] = (mhb_event_test){.name      = "high end of the range",
                             .g         = beyond_high,
                             .direction = 1,
                             .at_next   = true,
                             .end       = MHB_END_HIGH};
  test[1] = (mhb_event_test){.name      = "low end of the range",
                             .g         = beyond_low,
                             .direction = 1,
                             .at_next   = true,
                             .end       = MHB_END_LOW};
}

double mhb_fold_test(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  (void)context;
  return point->tangent[curve->n];
}

static bool changes_sign(const mhb_event_test *t) {
  if (t->direction > 0) return t->value_current < 0 && t->value_next >= 0;
  if (t->direction < 0) return t->value_current > 0 && t->value_next < 0;
  return t->value_current * t->value_next < 0;
}

static void swap(mhb_curve_point *a, mhb_curve_point *b) {
  mhb_curve_point old = *a;
  *a                  = *b;
  *b                  = old;
}

/* The test's event on the step, located in the curve's trial. */
static bool find(mhb_arclength *curve, const mhb_event_test *t, double *place) {
  if (!changes_sign(t)) return false;
  if (t->is_near && !t->is_near(curve, t->value_current, t->value_next, t->context)) return false;
  return mhb_arclength_locate(curve, t->g, t->context, t->value_current, t->value_next, t->exact,
                              place) &&
         (!t->accept || t->accept(curve, &curve->trial, t->context));
}

/* The trial becomes an event. */
static void keep(mhb_events *events, mhb_arclength *curve, const mhb_event_test *t, double place) {
  mhb_curve_point *point = &events->point[events->n];
  events->system         = curve->system;
  if (!point->x) mhb_curve_point_create(curve->system, point);
  swap(point, &curve->trial);
  events->event[events->n++] = (mhb_curve_event){t, place, point};
}

static bool coincide(const mhb_curve_event *a, const mhb_curve_event *b) {
  double apart = fabs(b->place - a->place), x = a->point->value, y = b->point->value;
  return apart < SAME_PLACE || (apart < SAME_PART && fabs(y - x) < SAME_VALUE * fabs(x));
}

/* In order along the step. Of events at one place one remains: a fold, if there is one. */
static void sort_and_merge(mhb_events *events) {
  mhb_curve_event *e    = events->event;
  int              kept = 0;
  for (int i = 1; i < events->n; i++)
    for (int j = i; j > 0 && e[j - 1].place > e[j].place; j--) {
      mhb_curve_event old = e[j];
      e[j]                = e[j - 1];
      e[j - 1]            = old;
    }
  for (int i = 0; i < events->n; i++) {
    bool fold = e[i].test->g == mhb_fold_test;
    if (kept > 0 && coincide(&e[kept - 1], &e[i])) {
      if (!fold) continue;
      kept--;
    }
    e[kept++] = e[i];
  }
  events->n = kept;
}

void mhb_events_locate(mhb_arclength *curve, int n_tests, mhb_event_test *test, mhb_events *events,
                       mhb_end *end) {
  double place;
  *end                     = MHB_END_NONE;
  events->n                = 0;
  events->fold_not_located = false;
  for (int i = 0; i < n_tests; i++) {
    mhb_event_test *t = &test[i];
    if (t->end == MHB_END_NONE || *end != MHB_END_NONE) continue;
    t->value_next = t->g(curve, &curve->next, t->context);
    if (t->at_next) {
      if (t->direction * t->value_next >= 0) *end = t->end;
    } else if (find(curve, t, &place)) {
      swap(&curve->next, &curve->trial);
      *end = t->end;
    }
  }
  for (int i = 0; i < n_tests && events->n < MHB_MAX_EVENTS; i++) {
    mhb_event_test *t = &test[i];
    if (t->end != MHB_END_NONE) continue;
    t->value_next = t->g(curve, &curve->next, t->context);
    if (find(curve, t, &place))
      keep(events, curve, t, place);
    else if (t->g == mhb_fold_test && changes_sign(t))
      events->fold_not_located = true;
  }
  sort_and_merge(events);
}

bool mhb_events_miss_fold(const mhb_arclength *curve, const mhb_events *events) {
  double value = curve->current.value, sense = curve->current.tangent[curve->n];
  for (int i = 0; i <= events->n; i++) {
    double to = i < events->n ? events->event[i].point->value : curve->next.value;
    if (copysign(1, sense) * (to - value) < -VISIBLE * mhb_arclength_size(curve)) return true;
    if (i < events->n && events->event[i].test->g == mhb_fold_test) sense = -sense;
    value = to;
  }
  return false;
}
