/* Newton's method in a plane across a path, and the path's tangent: what steps and located points share.
 *
 * Lengths are measured in y = [x/|x_now|, value/span]; the workspace of the path's Newton is left at the point worked on. */
#ifndef MHB_CONTINUATION_CORRECTOR_H
#define MHB_CONTINUATION_CORRECTOR_H

#include "mhb/continuation/arclength.h"

/* What a change of the parameter is compared with. */
double mhb_path_size(const mhb_path *path);

/* Length unit of x: the size of the current point; that of the curve (path->rest) where nothing moves. */
double mhb_path_unit(const mhb_path *path);

/* Inner product of two (dx, dvalue) in y, scale the unit of x. */
double mhb_path_inner(const mhb_path *path, double scale, const double *a, const double *b);

/* Residual, derivatives and slope at a point. */
void mhb_path_evaluate(mhb_path *path, const mhb_path_point *point);

/* The same, and note the relative residual. */
void mhb_path_measure(mhb_path *path, mhb_path_point *point);

/* Newton in the plane normal.(y - point at entry) = 0; clip bounds a correction. 1: converged. */
int mhb_path_correct(mhb_path *path, const double *normal, double clip, mhb_path_point *point);

/* Where no pair moves, as noted in path->still, all but the means is found without the law, which only says whether that
 * holds. 0: it does not. */
int mhb_path_correct_still(mhb_path *path, const double *normal, mhb_path_point *point);

/* Tangent and orientation at the point of the workspace, in the sense of along. 0: singular. */
int mhb_path_set_tangent(mhb_path *path, const double *along, mhb_path_point *point);

#endif
