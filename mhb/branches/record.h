/* A solution as a point of the response: motion, force, probes, states, error estimates. */
#ifndef MHB_BRANCHES_RECORD_H
#define MHB_BRANCHES_RECORD_H

#include "mhb/continuation/curve.h"
#include "mhb/response/response.h"

/* Append a point of a balance's curve to a branch. special: MHB_ORDINARY ...; seconds: spent on
 * it. */
void mhb_record(mhb_response *response, int branch, mhb_balance *balance,
                const mhb_curve_point *point, int special, double seconds);

/* x[n] <- the motion recorded at a point, as unknowns of a balance. Harmonics not recorded are 0.
 */
void mhb_recorded_motion(const mhb_branch *branch, int point, const mhb_balance *balance,
                         double *x);

#endif
