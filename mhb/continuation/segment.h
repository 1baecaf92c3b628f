/* A segment of a curve: traced from a seed, step by step, until an event ends it. */
#ifndef MHB_CONTINUATION_SEGMENT_H
#define MHB_CONTINUATION_SEGMENT_H

#include "mhb/continuation/arclength.h"
#include "mhb/continuation/closed_curve.h"
#include "mhb/continuation/events.h"

/* Where a segment starts. */
typedef enum {
  MHB_SEED_SOLUTION,  /* at a solution x, towards rising or falling values */
  MHB_SEED_CROSSING,  /* at a solution x of another curve, which the segment leaves along `along` */
  MHB_SEED_EXCURSION, /* where the curve through x, on an end of the range and heading outwards,
                       * comes back to that end */
  MHB_SEED_UNDER_WAY  /* host->curve, the tests' values and the counts are those of a segment under
                      * way, before a step: it goes on */
} mhb_seed_kind;

typedef struct {
  mhb_seed_kind       kind;
  const double       *x;          /* [n] of the curve that the host starts with */
  double              value;      /* of the parameter at x */
  int                 direction;  /* SOLUTION: +1 or -1; EXCURSION: the end, +1 high or -1 low */
  const double       *along;      /* [n] CROSSING */
  mhb_excursion_reach reach;      /* EXCURSION */
  double              step;       /* EXCURSION: length of the first step in y; 0: the usual one */
  bool                skip_first; /* the first point is in another segment already */
} mhb_seed;

/* What a segment asks of whoever traces it: the owner of the curve and of the recorded points. */
typedef struct mhb_segment_host mhb_segment_host;
struct mhb_segment_host {
  mhb_arclength  *curve;        /* at the level of accuracy in use */
  int             n_tests;      /* of the events looked for */
  mhb_event_test *test;         /* [n_tests] */
  mhb_events     *events;       /* of the level in use */
  int             max_points;   /* of the segment */
  int             n_points;     /* of the segment so far, each step's last point and its events */
  int             n_tiny;       /* tiny steps in a row */
  bool            out_of_reach; /* of estimate: the point asks for a level that has no solution near
                                 * by; the segment ends before it */
  mhb_end         reached; /* out: why the segment ended; MHB_END_NONE: under way when stopped */

  /* Estimate the errors of a point just corrected. At first or next: *raised tells that the level
   * does not suffice there, and that the host has moved curve->current to a higher level. */
  shb_status (*estimate)(mhb_segment_host *host, mhb_curve_point *point, bool *raised);
  /* Estimate the errors of a point located on a step. */
  void (*estimate_event)(mhb_segment_host *host, mhb_curve_point *point);
  /* The same of the events of a step, before one is recorded; *raised as of estimate: the step is
   * repeated. NULL: estimate_event is called, and all levels suffice. */
  shb_status (*estimate_between)(mhb_segment_host *host, mhb_curve_point *point, bool *raised);
  /* curve->current is accepted. *moved: the host has moved it to a lower level. */
  shb_status (*accept)(mhb_segment_host *host, bool *moved);
  /* The segment has found its first point, curve->current; the host may refuse it by an *end.
   * NULL: nothing to do. */
  shb_status (*started)(mhb_segment_host *host, const mhb_seed *seed, mhb_end *end);
  /* All points so far are recorded, and the next step is to begin. NULL: nothing to do. */
  shb_status (*before_step)(mhb_segment_host *host);
  /* Shorten curve->step; NULL: never. */
  void (*limit_step)(mhb_segment_host *host);
  /* Append a point to the segment. *go_on false: interrupted; the segment stops before its next
   * step. */
  shb_status (*record)(mhb_segment_host *host, mhb_curve_point *point, int special, bool *go_on);
};

/* Trace a segment from a seed; its points go to host->record. *end is never MHB_END_NONE.
 * Errors: those of the host. */
shb_status mhb_trace_segment(mhb_segment_host *host, const mhb_seed *seed, mhb_end *end);

#endif
