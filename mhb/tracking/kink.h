/* A peak on a kink of the response curve: the slope of the amplitude jumps from above 0 to below 0
 * (docs/theory/tracking.md). A phase of slip or an opening begins there.
 *
 * At one value of the parameter q the response curve is z(s) = (x, xi), xi = length omega/range,
 * with s = c . (z - z_0) along a unit vector c. G = dA/ds changes its sign at the kink. Its place
 * s_k is bracketed. Derivatives come from both sides, - and +, at fixed s:
 *
 *   ds_k/dq = (A_q+ - A_q-)/(G- - G+)
 *   dA/dq   = (G- A_q+ - G+ A_q-)/(G- - G+) */
#ifndef MHB_TRACKING_KINK_H
#define MHB_TRACKING_KINK_H

#include "mhb/tracking/peak_places.h"

typedef struct mhb_kink mhb_kink;

/* The balance must outlive it. */
mhb_kink *mhb_kink_create(mhb_balance *balance, const mhb_tracking *tracking);
void      mhb_kink_destroy(mhb_kink *kink);

/* The peak at at->value near the motion x[n] and at->omega. false: it is none on a kink.
 *   why  out  MHB_END_SMOOTH: the next maximum of the response curve is smooth; it is in at */
bool mhb_kink_start(mhb_kink *kink, const double *x, mhb_peak_place *at, mhb_end *why);

/* The smaller slip share (peak_system.h) of both sides of the maximum found last, smooth or not. */
double mhb_kink_slip_share(const mhb_kink *kink);

/* That maximum.
 *   x   out  [n] its motion
 *   by  out  dA/dq by all parameters; NULL: not wanted. The weights of both sides are those above.
 *            At a smooth maximum they lead to G = 0, which the law's error hides. */
void mhb_kink_maximum(mhb_kink *kink, double *x, double by[MHB_PEAK_PARAMETERS]);

/* Follow the peak on a kink from a seed both ways into an empty branch (peak_places.h). It ends
 * where the peak leaves the kink (MHB_END_SMOOTH).
 * *found false: the seed is no such peak. */
shb_status mhb_trace_kink(mhb_balance *balance, const mhb_tracking *tracking,
                          const mhb_tracking_seed *seed, mhb_response *response, int branch,
                          bool *found, mhb_tracking_end *end);

#endif
