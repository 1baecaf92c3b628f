/* Traces segments of a balance's curves. It chooses the harmonics, has the table of folds, peaks
 * and ends, and records each point with its forces, states and error estimates.
 *
 * Segments become branches of the tracer's own store. A chain joins them (chain.h).
 *
 * The state after each segment is kept, and that of the segment under way on demand. A later run
 * with these segments and states asks for the same segments in the same order. It gets the same
 * points, the last segment goes on where it stopped, and all that follows agrees to the bit. */
#ifndef MHB_BRANCHES_TRACER_H
#define MHB_BRANCHES_TRACER_H

#include "mhb/branches/chain.h"
#include "mhb/branches/harmonic_selection.h"
#include "mhb/continuation/segment.h"
#include "mhb/response/monitor.h"

typedef struct mhb_tracer mhb_tracer;

/* The plan of a segment: its seed, and where it ends. */
typedef struct {
  mhb_seed seed;     /* x of a balance of m harmonics */
  int      m;        /* harmonics to start with */
  bool     closes;   /* it ends where it comes back to its start */
  bool     known;    /* EXCURSION: it may come back to a point that is recorded already; else that
                      * counts as no start */
  int      recorded; /* points that its branch has already: max_points counts them */
  const mhb_curve_place *target; /* it ends where it arrives there (closes: false); or NULL */
} mhb_segment_plan;

struct mhb_tracer {
  mhb_segment_host     host; /* first: the host's functions get it back */
  mhb_harmonic_levels *levels;
  mhb_response        *store;   /* the segments */
  int                  segment; /* under way; -1: none */
  mhb_monitor         *monitor;
  bool joins; /* curves beside the main one: they end where they meet one of higher symmetry */
  bool accepts_all;    /* points that ask for harmonics out of reach do not end a segment */
  bool is_beside_wave; /* with joins: the curve under way is of other motions than the wave */
  mhb_segment_plan  plan;
  mhb_curve_place   start;            /* of the curve under way */
  bool              returns_to_start; /* it ends there; noted anew when more harmonics move it */
  mhb_curve_return *returns;          /* [copies] contexts of the tests of closure */
  int              *output;           /* [outputs] contexts of the tests of peaks */
  double            clock;            /* s, when the last point was recorded */
  double            farthest;         /* highest value of a point so far */
  int               n_states;         /* of segments that have ended or stopped */
  mhb_trace_state  *state;            /* [n_states] */
  const mhb_unfinished *earlier;      /* segments of an earlier run, not traced again; or NULL */
  /* Called before each step, to publish the curves so far; NULL: never. */
  shb_status (*publish)(void *context);
  void *context;
};

/* For a branch of a response. joins: segments end where they meet a curve of lower order, or in a
 * ring the wave. */
shb_status mhb_tracer_create(mhb_balance *balance, const mhb_response *response, int branch,
                             bool joins, mhb_monitor *monitor, mhb_tracer **tracer);
void       mhb_tracer_destroy(mhb_tracer *tracer);

/* Trace a segment.
 *   segment  out  branch of the store, perhaps without points */
shb_status mhb_tracer_trace(mhb_tracer *tracer, const mhb_segment_plan *plan, int *segment,
                            mhb_end *end);

/* The segments so far with their states, for a later run; also from t->publish. */
shb_status mhb_tracer_unfinished(mhb_tracer *tracer, mhb_unfinished **unfinished);

/* The least level of an earlier run; 0 without one. */
int mhb_tracer_least_level(const mhb_unfinished *earlier);

/* The curve under way, at the last point of the last segment. */
mhb_arclength *mhb_tracer_curve(const mhb_tracer *tracer);
mhb_balance   *mhb_tracer_balance(const mhb_tracer *tracer);

/* Discard a segment: it is left without points. */
void mhb_tracer_forget(mhb_tracer *tracer, int segment);

/* x[n] <- a recorded point as unknowns of the balance that recorded it, made the one in use. */
shb_status mhb_tracer_recorded(mhb_tracer *tracer, int segment, int point, double *x);

/* Distance in y, relative to the motion, at which points count as the same. It covers the effect of
 * a change of the number of harmonics. */
double mhb_tracer_same(const mhb_tracer *tracer);

#endif
