/* A curve of the response under way: it is followed step by step, its folds and peaks are located, each point is recorded with its
 * forces, states and error estimates. What the steps lead to, branches, is main_branch.h. */
#ifndef MHB_BRANCHES_TRACER_H
#define MHB_BRANCHES_TRACER_H

#include "mhb/branches/branch_stability.h"
#include "mhb/branches/harmonic_selection.h"
#include "mhb/branches/main_branch.h"
#include "mhb/continuation/closed_curve.h"
#include "mhb/continuation/special_points.h"

enum { MHB_MAX_BEGINS = 64 };

typedef struct {
  mhb_branch_editor    host; /* first: the callbacks get it back */
  mhb_harmonic_levels *harmonics;
  mhb_balance         *residual; /* of the rung in use, as the path */
  mhb_arclength       *path;
  mhb_response        *response;
  int                  branch;
  mhb_monitor         *monitor;
  int                  n_outputs;
  double              *before, *after; /* [outputs] slopes of the amplitudes at now and next */
  double              *x;              /* [n] a first solution */
  mhb_special_points   landmarks;
  double               clock;
  double               farthest;                       /* highest value of the parameter reached */
  int                  crawling;                       /* tiny steps in a row */
  int                  first[MHB_MAX_BEGINS], n_first; /* where the curve begins, and begins anew */
  bool                 either; /* it ends at either end of the range, and does not leave it */
  bool                 joins;  /* it ends where it passes over into a curve of lower order */
  mhb_curve_start      closed; /* where it began, or is to arrive; empty: it cannot close */
  mhb_branch_stability *judge; /* NULL: stability by folds */
} mhb_tracer;

/* How a curve ends that is complete. */
extern const char MHB_WHOLE[], MHB_CLOSED[], MHB_JOINED[], MHB_TURNED_BACK[];

/* What it needs, all made before the first point. Errors: SHB_ERR_IO no memory; destroy it then too. */
shb_status mhb_tracer_create(mhb_tracer *f, mhb_balance *residual, mhb_response *response,
                             int branch, mhb_monitor *monitor);
void       mhb_tracer_destroy(mhb_tracer *f);

/* Begin, or begin anew, at f->x, a solution at a value of the parameter, towards rising (+1) or falling (-1) ones; recorded: as
 * the first point of a piece. *found: it was a solution. */
shb_status mhb_tracer_begin(mhb_tracer *f, double value, int direction, bool recorded, bool *found,
                            bool *go_on);

/* How near a curve comes to a point of its own that it passes again, relative to the motion: what a change of the number of
 * harmonics may do. */
double mhb_tracer_closeness(const mhb_tracer *f);

/* What lies at path->now, as the rest of a start: slopes, a number of harmonics that suffices, errors. */
shb_status mhb_tracer_arrive(mhb_tracer *f);

/* One step and what lies on it. *end, NULL at entry: why the curve ends here, one of the above or an obstacle; a curve that ends
 * at the low end of the range only leaves and comes back (mhb_arclength_excursion). *go_on false: interrupted. */
shb_status mhb_tracer_step(mhb_tracer *f, bool *go_on, const char **end);

/* The last recorded point is an end of the range at which a curve with `either` ended: follow it outside, a little (mhb_arclength_excursion_within_budget).
 * *back: it has come back into the range where no curve of this preload was before; that point is recorded, as the first of a
 * piece, and is path->now. */
shb_status mhb_tracer_return(mhb_tracer *f, bool *back, bool *go_on);

/* Steps until the curve ends. */
shb_status mhb_tracer_run(mhb_tracer *f, bool *go_on, const char **end);

/* Record a point whose errors are estimated. */
shb_status mhb_tracer_record(mhb_tracer *f, mhb_curve_point *point, int special, bool *go_on);

/* Leave the residual's workspace at a point that was corrected earlier. */
void mhb_tracer_revisit(mhb_tracer *f, const mhb_curve_point *point);

/* The rung in use is the harmonics' again. */
void mhb_tracer_use_rung(mhb_tracer *f);

void mhb_tracer_lock(const mhb_tracer *f, bool locked);

#endif
