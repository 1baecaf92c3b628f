/* Events on a step of a curve: zeros of test functions (Seydel 2010, Govaerts 2000), in one table.
 *
 * A segment of a curve (segment.h) has a table of tests. Tests that end the segment come first: the
 * step is cut short at the first of their events. The others are located on what is left of the
 * step, in order along it. */
#ifndef MHB_CONTINUATION_EVENTS_H
#define MHB_CONTINUATION_EVENTS_H

#include "mhb/continuation/event_location.h"

enum { MHB_MAX_EVENTS = 16 };

/* Why a segment of a curve ends. */
typedef enum {
  MHB_END_NONE,        /* it goes on */
  MHB_END_HIGH,        /* the high end of the range */
  MHB_END_LOW,         /* the low end of the range */
  MHB_END_CLOSED,      /* the curve has come back to a place of its own */
  MHB_END_JOINED,      /* it meets a curve of lower order */
  MHB_END_STALLED,     /* no step converged */
  MHB_END_TINY_STEPS,  /* the steps stayed tiny */
  MHB_END_TURNED,      /* a tracked maximum becomes a minimum */
  MHB_END_CORNER,      /* a tracked peak meets the end of slip */
  MHB_END_SMOOTH,      /* a tracked peak leaves its kink */
  MHB_END_MEETS_PLUS,  /* a tracked pair of multipliers meets at +1 */
  MHB_END_MEETS_MINUS, /* the same at -1 */
  MHB_END_FREQUENCY,   /* a tracked point leaves the frequency range */
  MHB_END_HARMONICS,   /* no solution near by with as many harmonics as a point asks for */
  MHB_END_MAX_POINTS,  /* mhb.max_points reached */
  MHB_END_NO_START,    /* no solution where it was to start */
  MHB_END_INTERRUPTED, /* stopped from outside */
  MHB_N_ENDS
} mhb_end;

/* As the response file and the report have it. */
const char *mhb_end_text(mhb_end end);

typedef struct {
  const char       *name;
  mhb_test_function g;
  void             *context;   /* of g, is_near and accept */
  int               direction; /* of the sign change that counts: 1 rising, -1 falling, 0 both */
  bool at_next; /* the event is next itself as soon as g has the sign of direction there, or is 0 */
  /* Whether a sign change is worth locating; NULL: always. */
  bool (*is_near)(mhb_arclength *curve, double at_current, double at_next, void *context);
  /* Whether the located point is the event; NULL: always. */
  bool (*accept)(mhb_arclength *curve, const mhb_curve_point *point, void *context);
  double  exact;   /* where the event need not be exact: its error, relative to the chord; else 0 */
  int     special; /* of the recorded point: MHB_FOLD, MHB_PEAK, ... */
  mhb_end end;     /* of the segment; MHB_END_NONE: it goes on */
  double  value_current, value_next; /* of g at the ends of the step */
} mhb_event_test;

/* An event on the step. */
typedef struct {
  const mhb_event_test *test;
  double                place; /* fraction of the chord from current to next */
  mhb_curve_point      *point;
} mhb_curve_event;

typedef struct {
  mhb_curve_system *system;                /* of the points */
  mhb_curve_point   point[MHB_MAX_EVENTS]; /* made when first needed */
  int               n;                     /* events on the step */
  mhb_curve_event   event[MHB_MAX_EVENTS]; /* [n] in order along the step */
  bool              fold_not_located;      /* the step has a fold that could not be located */
} mhb_events;

void mhb_events_destroy(mhb_events *events);

/* Evaluate the tests at current, where a segment begins or goes on after a change of the system. */
void mhb_events_begin(mhb_arclength *curve, int n_tests, mhb_event_test *test);

/* Locate the events of a step. *end: of the event that ends the segment, whose point has become
 * next; or MHB_END_NONE. */
void mhb_events_locate(mhb_arclength *curve, int n_tests, mhb_event_test *test, mhb_events *events,
                       mhb_end *end);

/* Whether the parameter runs back between two points of the step without a fold. Two or more folds
 * then lie between them, which the signs at the ends do not show. */
bool mhb_events_miss_fold(const mhb_arclength *curve, const mhb_events *events);

/* The step is accepted: next becomes current, and so do the tests' values. */
void mhb_events_advance(int n_tests, mhb_event_test *test);

/* The tests that end a segment at the high and the low end of the range. */
void mhb_events_range_ends(mhb_event_test test[2]);

/* Test function of folds: the tangent's component of the parameter. */
double mhb_fold_test(mhb_arclength *curve, const mhb_curve_point *point, void *context);

#endif
