/* Peaks without slip of some pair, followed along a parameter q (docs/theory/tracking.md). They are
 * the corner between the stuck and the slipping side of one pair (corner_point.h), and the peak at
 * which all pairs stick. */
#ifndef MHB_TRACKING_CORNER_H
#define MHB_TRACKING_CORNER_H

#include "mhb/tracking/tracked_curve.h"

/* Follow a corner or stuck peak from a seed both ways into an empty branch (peak_places.h). It ends
 * at the ends of the range, where the corner is no maximum any more, or where a stuck peak begins
 * to slip (MHB_END_CORNER).
 * *found false: the seed is neither. */
shb_status mhb_trace_corner(mhb_balance *balance, const mhb_tracking *tracking,
                            const mhb_tracking_seed *seed, mhb_response *response, int branch,
                            bool *found, mhb_tracking_end *end);

#endif
