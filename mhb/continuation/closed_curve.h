/* When a curve has come back to where it began: in the same motion, or in that motion some periods of the excitation later. */
#ifndef MHB_CONTINUATION_CLOSED_CURVE_H
#define MHB_CONTINUATION_CLOSED_CURVE_H

#include "mhb/continuation/arclength.h"

typedef struct {
  int     rows, m, order;
  double *x, *tangent; /* [order][rows][2m+1] m: where it began and which way, later by j periods */
  double  value, rise; /* of the parameter; tangent in it */
  double  tolerance;   /* of the motion, relative */
} mhb_curve_start;

/* The curve begins at path->now. tolerance: what a change of the number of harmonics may do to the motion. SHB_ERR_IO: no memory. */
shb_status mhb_curve_start_begin(mhb_curve_start *curve, const mhb_arclength *path,
                                 double tolerance);
void       mhb_curve_start_free(mhb_curve_start *curve);

/* It is to be passed the other way. */
void mhb_curve_start_turn(mhb_curve_start *curve);

/* Of a point of the path from the beginning, in y. */
double mhb_curve_start_distance(const mhb_curve_start *curve, const mhb_arclength *path,
                                const mhb_curve_point *point);

/* Whether the step from path->now to next passes the beginning in the direction in which it was left. If so path->next
 * becomes that point, solved for; else it is as it was. The residual's workspace is left at next either way. */
int mhb_curve_start_passes(mhb_curve_start *curve, mhb_arclength *path);

/* Whether the curve has come to where its part of higher order vanishes: there it passes over into one of lower order, or into
 * itself some periods later. Shortens the next step so that it stays before that place. */
int mhb_subharmonic_part_vanishes(mhb_arclength *path);

#endif
