/* Pseudo-arclength continuation of r(x, value) = 0 through folds (Keller 1977, Seydel 2010).
 *
 * Arclength is measured in y = [x/|x_current|, value/parameter_scale]. The predictor follows the
 * tangent. The corrector is Newton's method in the plane normal to it. The step size follows the
 * number of corrections and the angle between tangents. The contact law is smooth only piecewise:
 * an angle that halving the step hardly lessens is a kink of the curve, and is accepted. */
#ifndef MHB_CONTINUATION_ARCLENGTH_H
#define MHB_CONTINUATION_ARCLENGTH_H

#include "mhb/continuation/curve.h"

typedef enum {
  MHB_ARCLENGTH_ON,       /* next is a further point in the range */
  MHB_ARCLENGTH_AT_END,   /* next lies exactly on the high end of the range */
  MHB_ARCLENGTH_AT_START, /* next lies exactly on the low end of the range */
  MHB_ARCLENGTH_STALLED   /* no step converged */
} mhb_arclength_outcome;

/* current <- the solution at a value, from x[n], towards rising (+1) or falling (-1) values. */
mhb_reason mhb_arclength_start(mhb_arclength *curve, const double *x, double value, int direction);

/* x[n] is the crossing of two curves. along[n] is the direction of the one to be traced. current
 * becomes its first point, 0.001 to 0.03 of |x| away. Not converged: there is no such curve. */
mhb_reason mhb_arclength_depart(mhb_arclength *curve, const double *x, double value,
                                const double *along);

/* One step from current: next becomes the new point. */
mhb_arclength_outcome mhb_arclength_step(mhb_arclength *curve);

/* The longest excursion beyond an end of the range. */
typedef enum {
  MHB_EXCURSION_FAR, /* five times the frequency, or four ranges */
  MHB_EXCURSION_NEAR /* half a range, at 10 to 30 % of the frequency, with few nonlinear steps */
} mhb_excursion_reach;

/* current lies on an end of the range, heading outwards. Follow the curve outside until it comes
 * back.
 *   end  in  -1 low, +1 high
 * Returns true if next lies on that end, heading inwards. */
bool mhb_arclength_excursion(mhb_arclength *curve, int end, mhb_excursion_reach reach);

#endif
