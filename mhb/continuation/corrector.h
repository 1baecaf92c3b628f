/* Newton's method in a plane across a curve, and the curve's tangent: shared by steps and events.
 *
 * Lengths are measured in y = [x/|x_current|, value/parameter_scale]. */
#ifndef MHB_CONTINUATION_CORRECTOR_H
#define MHB_CONTINUATION_CORRECTOR_H

#include "mhb/continuation/curve.h"

/* The size that a change of the parameter is compared with. */
double mhb_arclength_size(const mhb_arclength *curve);

/* Unit of x: the size of the current point, or that of the curve where nothing moves. */
double mhb_arclength_unit(const mhb_arclength *curve);

/* Inner product of two (dx, dvalue) in y; unit: that of x. */
double mhb_arclength_inner(const mhb_arclength *curve, double unit, const double *a,
                           const double *b);

/* Linearise at a point and note the relative residual. */
void mhb_arclength_measure(mhb_arclength *curve, mhb_curve_point *point);

/* Newton in the plane normal.(y - point at entry) = 0; clip bounds a correction. 1: converged. */
int mhb_arclength_correct(mhb_arclength *curve, const double *normal, double clip,
                          mhb_curve_point *point);

/* Tangent and orientation at a linearised point, in the sense of along[n + 1]. 0: singular. */
int mhb_arclength_set_tangent(mhb_arclength *curve, const double *along, mhb_curve_point *point);

#endif
