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
  mhb_judge_host   host; /* first: the callbacks get it back */
  mhb_harmonics   *harmonics;
  mhb_residual    *residual; /* of the rung in use, as the path */
  mhb_path        *path;
  mhb_response    *response;
  int              branch;
  mhb_monitor     *monitor;
  int              n_outputs;
  double          *before, *after; /* [outputs] slopes of the amplitudes at now and next */
  double          *x;              /* [n] a first solution */
  mhb_landmarks    landmarks;
  double           clock;
  double           farthest;                       /* highest value of the parameter reached */
  int              crawling;                       /* tiny steps in a row */
  int              first[MHB_MAX_BEGINS], n_first; /* where the curve begins, and begins anew */
  bool             either; /* it ends at either end of the range, and does not leave it */
  bool             joins;  /* it ends where it passes over into a curve of lower order */
  mhb_closed_curve closed; /* where it began, or is to arrive; empty: it cannot close */
  mhb_judge       *judge;  /* NULL: stability by folds */
} mhb_follower;

/* How a curve ends that is complete. */
extern const char MHB_WHOLE[], MHB_CLOSED[], MHB_JOINED[], MHB_TURNED_BACK[];

/* What it needs, all made before the first point. Errors: SHB_ERR_IO no memory; destroy it then too. */
shb_status mhb_follower_create(mhb_follower *f, mhb_residual *residual, mhb_response *response,
                               int branch, mhb_monitor *monitor);
void       mhb_follower_destroy(mhb_follower *f);

/* Begin, or begin anew, at f->x, a solution at a value of the parameter, towards rising (+1) or falling (-1) ones; recorded: as
 * the first point of a piece. *found: it was a solution. */
shb_status mhb_follower_begin(mhb_follower *f, double value, int direction, bool recorded,
                              bool *found, bool *go_on);

/* How near a curve comes to a point of its own that it passes again, relative to the motion: what a change of the number of
 * harmonics may do. */
double mhb_follower_closeness(const mhb_follower *f);

/* What lies at path->now, as the rest of a start: slopes, a number of harmonics that suffices, errors. */
shb_status mhb_follower_arrive(mhb_follower *f);

/* One step and what lies on it. *end, NULL at entry: why the curve ends here, one of the above or an obstacle; a curve that ends
 * at the low end of the range only leaves and comes back (mhb_path_outside). *go_on false: interrupted. */
shb_status mhb_follower_step(mhb_follower *f, bool *go_on, const char **end);

/* The last recorded point is an end of the range at which a curve with `either` ended: follow it outside, a little (mhb_path_beyond).
 * *back: it has come back into the range where no curve of this preload was before; that point is recorded, as the first of a
 * piece, and is path->now. */
shb_status mhb_follower_return(mhb_follower *f, bool *back, bool *go_on);

/* Steps until the curve ends. */
shb_status mhb_follower_run(mhb_follower *f, bool *go_on, const char **end);

/* Record a point whose errors are estimated. */
shb_status mhb_follower_record(mhb_follower *f, mhb_path_point *point, int special, bool *go_on);

/* Leave the residual's workspace at a point that was corrected earlier. */
void mhb_follower_revisit(mhb_follower *f, const mhb_path_point *point);

/* The rung in use is the harmonics' again. */
void mhb_follower_use_rung(mhb_follower *f);

void mhb_follower_lock(const mhb_follower *f, bool locked);

#endif
