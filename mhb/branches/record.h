/* Putting a solution into the response: motion, force, probes, states, error estimates. */
#ifndef MHB_BRANCHES_RECORD_H
#define MHB_BRANCHES_RECORD_H

#include "mhb/branches/main_branch.h"

/* Append the solution the residual was just evaluated at. */
shb_status mhb_record(mhb_response *response, int branch, mhb_balance *residual,
                      const mhb_curve_point *point, int special, double seconds);

/* The motion recorded at a point as unknowns x of a residual; harmonics that were not recorded are 0. */
void mhb_recorded_motion(const mhb_branch *branch, int point, const mhb_balance *residual,
                         double *x);

/* Number of outputs whose peaks are followed: every probe, and v, u, w of the first two pairs. */
int mhb_outputs(const mhb_balance *residual);

/* Motion q[3 probes] of harmonic k at a point just corrected, and its change dq along the tangent. */
void mhb_probe_change(const mhb_arclength *path, const mhb_curve_point *point, int k,
                      double complex *q, double complex *dq);

/* d a^2/ds of output o along the tangent of a point just corrected, 0 below 1e-9 a^2; a = amplitude of the excitation's
 * harmonic. */
double mhb_output_slope(const mhb_arclength *path, const mhb_curve_point *point, int o);

#endif
