/* Peaks of a curve: of the blade that swings highest, and of the mean over the blades.
 *
 * The amplitude is that of mhb_response_output, on each blade. It is that of its first probe, or
 * of its first contact without probes. */
#ifndef MHB_AMPLIFICATION_RING_PEAK_H
#define MHB_AMPLIFICATION_RING_PEAK_H

#include "mhb/response/response.h"

typedef struct {
  double worst, worst_at; /* m, Hz: highest amplitude of any blade on the curve, and where */
  int    blade;           /* whose; from 0 */
  double mean, mean_at;   /* m, Hz: highest mean over the blades */
  bool   marked;          /* the error of one of both points is above the tolerance */
} mhb_ring_peak;

/* Amplitude of a blade at a point, m. A response of a wave has one blade. */
double mhb_blade_amplitude(const mhb_response *response, const mhb_branch *branch, int point,
                           int blade);

/* Over the points of a branch; zeros without points. Peaks are points of the curve, since the sweep
 * locates them. */
mhb_ring_peak mhb_ring_peak_of(const mhb_response *response, const mhb_branch *branch);

#endif
