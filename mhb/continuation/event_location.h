/* Location of an event between two points of a curve: where a test function changes its sign. */
#ifndef MHB_CONTINUATION_EVENT_LOCATION_H
#define MHB_CONTINUATION_EVENT_LOCATION_H

#include "mhb/continuation/curve.h"

/* A test function: a scalar along the curve at a corrected point, with its tangent. */
typedef double (*mhb_test_function)(mhb_arclength *curve, const mhb_curve_point *point,
                                    void *context);

/* Locate the sign change of g between current and next, where it is at_current and at_next.
 *
 *   exact     in   the error of the place allowed, relative to the chord; 0: the least
 *   trial     out  the point located, with its evaluation and tangent
 *   fraction  out  its place on the chord from current to next, 0 to 1
 * Returns true if it was located to exact, to 1e-9 of the chord, to 1e-10 of the value, or beside a
 * kink. Where the system's events are brief, 1e-8 of the value is enough.
 * Method: Illinois with planes across the chord, then bisection. Where events are brief, bisection
 * comes in as soon as Illinois falls behind it by two steps. Newton's method on g would fail,
 * because g may jump at kinks. */
bool mhb_arclength_locate(mhb_arclength *curve, mhb_test_function g, void *context,
                          double at_current, double at_next, double exact, double *fraction);

#endif
