/* Outputs along a curve of a balance: amplitudes whose peaks are located. */
#ifndef MHB_CONTINUATION_OUTPUTS_H
#define MHB_CONTINUATION_OUTPUTS_H

#include <complex.h>

#include "mhb/continuation/curve.h"

/* Number of outputs: every probe, then v, u, w of the first two pairs. In a ring of different
 * blades every probe is taken on the blade that swings highest, then as the mean over the blades.
 * Without probes the contact motion takes their place. */
int mhb_outputs(const mhb_balance *balance);

/* The harmonic of the balance whose amplitude outputs have: that of the settings, counted in the
 * excitation. */
int mhb_output_harmonic(const mhb_balance *balance);

/* Motion q[3 probes] of harmonic k at a point, m, and its change dq along the tangent. */
void mhb_probe_change(mhb_balance *balance, const mhb_curve_point *point, int k, double complex *q,
                      double complex *dq);

/* d a^2/ds of output o along the tangent of a point; 0 below 1e-9 a^2. a is the amplitude of
 * its harmonic: of a probe the semi-major axis, or its rss. Or a is the peak to peak, of all
 * harmonics. */
double mhb_output_slope(mhb_balance *balance, const mhb_curve_point *point, int o);

#endif
