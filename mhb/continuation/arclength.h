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
} mhb_curve_point;

typedef struct {
  mhb_balance          *residual;
  mhb_newton           *newton;
  mhb_linear_corrector *still;
  int                   n;
  double                low, high; /* range of the value */
  double                span;      /* unit of the value */
  double                least;     /* below it no value makes sense */
  double
      rest; /* m: unit of x where nothing moves, by the motion that the tangent leads to over the span */
  double step, longest;
  double tolerance;
  double
      stagnant; /* a residual below it that Newton no longer betters is rounding, or the law's own */
  int orientation, against; /* of the path; ordinary steps in a row that had the other one */
  mhb_curve_point now, next, probe; /* probe: scratch for located points */
  double         *chord;            /* [n+1] */
  double         *bracket[2];       /* [n+1] x and value on both sides of a point being located */
  double         *kept;             /* [n+1] an end of it */
  mhb_resonances  resonances;       /* in the range */
} mhb_arclength;

typedef enum {
  MHB_ARCLENGTH_ON,
  MHB_ARCLENGTH_AT_END,
  MHB_ARCLENGTH_AT_START,
  MHB_ARCLENGTH_STALLED
} mhb_arclength_outcome;

shb_status mhb_arclength_create(mhb_balance *residual, double low, double high,
                                mhb_arclength **path);
void       mhb_arclength_destroy(mhb_arclength *path);

/* Begin at a solution x at a value, towards rising (+1) or falling (-1) ones. Leaves the residual there. */
mhb_reason mhb_arclength_start(mhb_arclength *path, const double *x, double value, int direction);

/* Begin where two curves cross, at a solution x that lies on the one, along[n] the other: now becomes its first point,
 * .001 to .03 of |x| away. Not converged: there is none. Leaves the residual there. */
mhb_reason mhb_arclength_depart(mhb_arclength *path, const double *x, double value,
                                const double *along);

/* One step: path->next becomes the new point, path->now stays the old one. AT_END, AT_START: next lies exactly on the
 * range's high or low end. The residual's workspace is left at next. */
mhb_arclength_outcome mhb_arclength_step(mhb_arclength *path);

/* next lies on the end of the range that outcome (AT_START, AT_END) tells: go on outside the range until the path comes back
 * to that end. ON: next is there, heading inwards; STALLED: it does not come back. */
mhb_arclength_outcome mhb_arclength_excursion(mhb_arclength *path, mhb_arclength_outcome outcome);

/* The same from path->now, a solution on that end, but no farther than half a range beyond it (frequency: at least one, at most
 * three tenths of it) and with few steps while a contact slips or opens. now is the point before next then. */
mhb_arclength_outcome mhb_arclength_excursion_within_budget(mhb_arclength        *path,
                                                            mhb_arclength_outcome outcome);

/* now <- next */
void mhb_arclength_advance(mhb_arclength *path);

#endif
