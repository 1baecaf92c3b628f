/* Newton's method in a plane across a path, and the path's tangent: what steps and located points share.
 *
 * Lengths are measured in y = [x/|x_now|, value/span]; the workspace of the path's Newton is left at the point worked on. */
#ifndef MHB_CONTINUATION_CORRECTOR_H
#define MHB_CONTINUATION_CORRECTOR_H

#include "mhb/continuation/arclength.h"

/* What a change of the parameter is compared with. */
double mhb_arclength_size(const mhb_arclength *path);

/* Length unit of x: the size of the current point; that of the curve (path->rest) where nothing moves. */
double mhb_arclength_unit(const mhb_arclength *path);

/* Inner product of two (dx, dvalue) in y, scale the unit of x. */
double mhb_arclength_inner(const mhb_arclength *path, double scale, const double *a,
                           const double *b);

/* Residual, derivatives and slope at a point. */
void mhb_arclength_evaluate(mhb_arclength *path, const mhb_curve_point *point);

/* The same, and note the relative residual. */
void mhb_arclength_measure(mhb_arclength *path, mhb_curve_point *point);

/* Newton in the plane normal.(y - point at entry) = 0; clip bounds a correction. 1: converged. */
int mhb_arclength_correct(mhb_arclength *path, const double *normal, double clip,
                          mhb_curve_point *point);

/* Where no pair moves, as noted in path->still, all but the means is found without the law, which only says whether that
 * holds. 0: it does not. */
int mhb_arclength_correct_still(mhb_arclength *path, const double *normal, mhb_curve_point *point);

/* Tangent and orientation at the point of the workspace, in the sense of along. 0: singular. */
int mhb_arclength_set_tangent(mhb_arclength *path, const double *along, mhb_curve_point *point);

#endif
