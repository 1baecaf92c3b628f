/* Peaks that are solved for at one value of the parameter q at a time, followed along q.
 *
 * The equations of peak_system.h do not hold there: at a corner or stuck peak (corner.h), and at a
 * peak on a kink (kink.h). A family says where its peak is at a value. This module walks along q,
 * finds the ends and records the points. */
#ifndef MHB_TRACKING_PEAK_PLACES_H
#define MHB_TRACKING_PEAK_PLACES_H

#include "mhb/tracking/tracked_curve.h"

typedef struct {
  double value, omega, amplitude, slope; /* slope: dA/dq along the curve */
  double peak;   /* rad/s: omega, or where the motions that overhang a corner end */
  double rate;   /* domega/dq, 0 of a stuck peak */
  double margin; /* it is 0 where the peak leaves the family, and < 0 beyond; NAN: not known */
} mhb_peak_place;

typedef struct mhb_peak_family mhb_peak_family;
struct mhb_peak_family {
  mhb_balance        *balance;
  const mhb_tracking *tracking;

  /* Whether there is a peak at at->value near at->omega; fills the place.
   *   why  out  what it is instead */
  bool (*is_peak)(mhb_peak_family *family, mhb_peak_place *at, mhb_end *why);

  /* x, r, residual and evaluation of the point <- the motion at a place that is_peak has filled,
   * with every pair's own law. The evaluation is in use. false: it does not balance there. */
  bool (*balance_at)(mhb_peak_family *family, const mhb_peak_place *at, mhb_curve_point *point);
};

/* The place at another value, with the same slopes. */
mhb_peak_place mhb_peak_place_at(const mhb_peak_place *from, double value);

/* Follow a family from a peak both ways into an empty branch that ascends in the parameter. Points
 * are as dense as linear interpolation of the amplitude to 3e-5 asks for. MHB_OPTIMUM marks where
 * the amplitude is stationary.
 * *found false: the first place does not balance. */
shb_status mhb_trace_peak_places(mhb_peak_family *family, const mhb_peak_place *first,
                                 mhb_response *response, int branch, bool *found,
                                 mhb_tracking_end *end);

#endif
