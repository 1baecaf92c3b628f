/* Closed curves: whether a curve has come back to its start. The motion there is the same, or its
 * copy some periods of the excitation later, or some blades further in a ring of equal blades. */
#ifndef MHB_CONTINUATION_CLOSED_CURVE_H
#define MHB_CONTINUATION_CLOSED_CURVE_H

#include "mhb/continuation/curve.h"

/* A place of a curve, and the direction in which the curve is to pass it. */
typedef struct {
  int     rows, row_length, copies; /* as of the system (curve.h) where it was noted */
  double *x, *tangent;              /* [copy][rows][row_length] */
  double  value, rate;              /* of the parameter; the tangent in it */
  double  size;                     /* |x| of the place; 1 at rest */
  double  tolerance;                /* distance in y that counts as the same place */
} mhb_curve_place;

/* The place and direction of a point. tolerance: of the motion, relative. */
void mhb_curve_place_note(mhb_curve_place *place, const mhb_curve_system *system,
                          const mhb_curve_point *point, double tolerance);
/* The place is empty then: a zeroed one. */
void mhb_curve_place_free(mhb_curve_place *place);

/* The place is to be passed in the other direction. */
void mhb_curve_place_turn(mhb_curve_place *place);

/* Distance in y of a point from the nearest copy. */
double mhb_curve_place_distance(const mhb_curve_place *place, const mhb_arclength *curve,
                                const mhb_curve_point *point);

/* One copy of a place, as the context of the functions below (events.h). */
typedef struct {
  const mhb_curve_place *place;
  int                    copy;
} mhb_curve_return;

/* Whether the copy is the place itself. A motion that repeats after fewer periods has such copies.
 */
bool mhb_curve_return_repeats(const mhb_curve_return *at);

/* Test function: how far a point lies beyond the copy, in the direction of passing. */
double mhb_curve_return_ahead(mhb_arclength *curve, const mhb_curve_point *point, void *context);

/* Whether the chord of the step passes the copy within 0.3 of its length. */
bool mhb_curve_return_is_near(mhb_arclength *curve, double at_current, double at_next,
                              void *context);

/* Whether a point is the copy, to the place's tolerance. */
bool mhb_curve_return_arrived(mhb_arclength *curve, const mhb_curve_point *point, void *context);

#endif
