/* Outputs along a curve: amplitudes whose peaks are located, and their slopes along the tangent. */
#ifndef MHB_CONTINUATION_OUTPUTS_H
#define MHB_CONTINUATION_OUTPUTS_H

#include "mhb/continuation/arclength.h"

/* Number of outputs whose peaks are followed: every probe, and v, u, w of the first two pairs. */
int mhb_outputs(const mhb_balance *residual);

/* Motion q[3 probes] of harmonic k at a point just corrected, and its change dq along the tangent. */
void mhb_probe_change(const mhb_arclength *path, const mhb_curve_point *point, int k,
                      double complex *q, double complex *dq);

/* d a^2/ds of output o along the tangent of a point just corrected, 0 below 1e-9 a^2; a = amplitude of the excitation's
 * harmonic. */
double mhb_output_slope(const mhb_arclength *path, const mhb_curve_point *point, int o);

#endif
