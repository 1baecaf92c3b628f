/* Pseudo-arclength continuation of r(x, value) = 0 through folds (Keller 1977, Seydel 2010).
 *
 * Arclength is measured in y = [x/|x_current|, value/parameter_scale]. The predictor follows the
 * tangent. The corrector is Newton's method in the plane normal to it. The step size follows the
 * number of corrections and the angle between tangents. The contact law is smooth only piecewise:
 * an angle that halving the step hardly lessens is a kink of the curve, and is accepted. */
#ifndef MHB_CONTINUATION_ARCLENGTH_H
#define MHB_CONTINUATION_ARCLENGTH_H

#include "mhb/continuation/curve_system.h"

struct mhb_arclength {
  mhb_curve_system *system; /* owned */
  int               n;
  double            low, high;       /* range of the value */
  double            parameter_scale; /* unit of the value */
  double          amplitude_at_rest; /* unit of x where nothing moves: |dx/dvalue| over the range */
  double          step, longest;     /* the next step's length; the longest allowed */
  double          tolerance;         /* of |r|/|x| */
  double          roundoff_level; /* a residual below it that stagnates is accepted as round-off */
  int             orientation;    /* of the curve */
  int             n_reversed;     /* points in a row with the other orientation */
  mhb_curve_point current, next;  /* the ends of the last step */
  mhb_curve_point trial;          /* a point located on it */
  mhb_curve_point bracket[3];     /* of a search on it: both ends, and a former one */
  double         *chord;          /* [n + 1] direction of a step or a search */
  double         *column, *row, *delta; /* [n + 1] of the bordered system */
};

typedef enum {
  MHB_ARCLENGTH_ON,       /* next is a further point in the range */
  MHB_ARCLENGTH_AT_END,   /* next lies exactly on the high end of the range */
  MHB_ARCLENGTH_AT_START, /* next lies exactly on the low end of the range */
  MHB_ARCLENGTH_STALLED   /* no step converged */
} mhb_arclength_outcome;

/* Takes over the system, also if it fails. SHB_ERR_IO: no memory. */
shb_status mhb_arclength_create(mhb_curve_system *system, double low, double high,
                                mhb_arclength **curve);
void       mhb_arclength_destroy(mhb_arclength *curve);

/* A point of a curve with arrays of its own; destroy accepts a zeroed one. SHB_ERR_IO: no memory. */
shb_status mhb_curve_point_create(mhb_curve_system *system, mhb_curve_point *point);
void       mhb_curve_point_destroy(mhb_curve_system *system, mhb_curve_point *point);

/* current <- the solution at a value, from x[n], towards rising (+1) or falling (-1) values. */
mhb_reason mhb_arclength_start(mhb_arclength *curve, const double *x, double value, int direction);

/* x[n] is the crossing of two curves; along[n] is the direction of the one to be traced. current
 * becomes its first point, 0.001 to 0.03 of |x| away. Not converged: there is no such curve. */
mhb_reason mhb_arclength_depart(mhb_arclength *curve, const double *x, double value,
                                const double *along);

/* One step from current: next becomes the new point. */
mhb_arclength_outcome mhb_arclength_step(mhb_arclength *curve);

/* current <- next */
void mhb_arclength_advance(mhb_arclength *curve);

/* How far an excursion beyond an end of the range may go. */
typedef enum {
  MHB_EXCURSION_FAR, /* five times the frequency, or four ranges */
  MHB_EXCURSION_NEAR /* half a range, at 10 to 30 % of the frequency, with few nonlinear steps */
} mhb_excursion_reach;

/* current lies on an end of the range, the low (-1) or the high one (+1), heading outwards: follow
 * the curve outside until it comes back. True: next lies on that end, heading inwards. */
bool mhb_arclength_excursion(mhb_arclength *curve, int end, mhb_excursion_reach reach);

#endif
