/* Points of a path between two steps: folds, peaks, crossings of the unit circle. */
#ifndef MHB_CONTINUATION_EVENT_LOCATION_H
#define MHB_CONTINUATION_EVENT_LOCATION_H

#include "mhb/continuation/arclength.h"

/* A scalar that is followed along the path at a point just corrected; its sign change marks an event. */
typedef double (*mhb_arclength_indicator)(const mhb_arclength *path, const mhb_curve_point *point,
                                          void *context);

/* Locate the sign change of indicator between now and next, into path->probe. Illinois with planes across the chord,
 * never Newton on a function that jumps at kinks. 1: found, to 1e-9 of the chord or 1e-8 of the value. */
int mhb_arclength_locate(mhb_arclength *path, mhb_arclength_indicator indicator, void *context,
                         double at_now, double at_next, double *fraction);

#endif
