/* Pseudo-arclength continuation of r(x, value) = 0 through folds; value: of the parameter that the residual follows, the frequency mostly.
 *
 * Arclength is measured in y = [x/|x_current|, value/span]. A tangent predictor, then Newton in the plane normal to
 * it; the step follows the number of iterations and the angle between tangents. The law is only piecewise smooth: an
 * angle that halving the step hardly lessens is a kink of the curve, not curvature, and is accepted. Resonances of modes that
 * hardly move the contact, and are felt all the same (mhb/continuation/resonance_detection.h), are not stepped over. */
#ifndef MHB_CONTINUATION_ARCLENGTH_H
#define MHB_CONTINUATION_ARCLENGTH_H

#include "mhb/balance/newton.h"
#include "mhb/continuation/linear_corrector.h"
#include "mhb/continuation/linear_resonances.h"

typedef struct {
  double *x;       /* [n] m */
  double  value;   /* of the parameter; rad/s for the frequency */
  double *tangent; /* [n+1] d(x, value) along the path, unit length in y */
  int orientation; /* sign of det [J r_value; tangent]: the same all along a path, but for bifurcations */
  int    iterations;
  double residual;          /* |r|/|x| */
  double truncation, modal; /* relative error estimates, see truncation_error.h */
  int    truncation_kind;   /* mhb_truncation_kind */
} mhb_path_point;

typedef struct {
  mhb_residual *residual;
  mhb_newton   *newton;
  mhb_still    *still;
  int           n;
  double        low, high; /* range of the value */
  double        span;      /* unit of the value */
  double        least;     /* below it no value makes sense */
  double
      rest; /* m: unit of x where nothing moves, by the motion that the tangent leads to over the span */
  double step, longest;
  double tolerance;
  double
      stagnant; /* a residual below it that Newton no longer betters is rounding, or the law's own */
  int orientation, against;        /* of the path; ordinary steps in a row that had the other one */
  mhb_path_point now, next, probe; /* probe: scratch for located points */
  double        *chord;            /* [n+1] */
  double        *bracket[2];       /* [n+1] x and value on both sides of a point being located */
  double        *kept;             /* [n+1] an end of it */
  mhb_resonances resonances;       /* in the range */
} mhb_path;

typedef enum { MHB_PATH_ON, MHB_PATH_AT_END, MHB_PATH_AT_START, MHB_PATH_STALLED } mhb_path_outcome;

shb_status mhb_path_create(mhb_residual *residual, double low, double high, mhb_path **path);
void       mhb_path_destroy(mhb_path *path);

/* Begin at a solution x at a value, towards rising (+1) or falling (-1) ones. Leaves the residual there. */
mhb_reason mhb_path_start(mhb_path *path, const double *x, double value, int direction);

/* Begin where two curves cross, at a solution x that lies on the one, along[n] the other: now becomes its first point,
 * .001 to .03 of |x| away. Not converged: there is none. Leaves the residual there. */
mhb_reason mhb_path_depart(mhb_path *path, const double *x, double value, const double *along);

/* One step: path->next becomes the new point, path->now stays the old one. AT_END, AT_START: next lies exactly on the
 * range's high or low end. The residual's workspace is left at next. */
mhb_path_outcome mhb_path_step(mhb_path *path);

/* next lies on the end of the range that outcome (AT_START, AT_END) tells: go on outside the range until the path comes back
 * to that end. ON: next is there, heading inwards; STALLED: it does not come back. */
mhb_path_outcome mhb_path_outside(mhb_path *path, mhb_path_outcome outcome);

/* The same from path->now, a solution on that end, but no farther than half a range beyond it (frequency: at least one, at most
 * three tenths of it) and with few steps while a contact slips or opens. now is the point before next then. */
mhb_path_outcome mhb_path_beyond(mhb_path *path, mhb_path_outcome outcome);

/* now <- next */
void mhb_path_advance(mhb_path *path);

#endif
