/* Putting a solution into the response: motion, force, probes, states, error estimates. */
#ifndef MHB_BRANCHES_RECORD_H
#define MHB_BRANCHES_RECORD_H

#include "mhb/continuation/arclength.h"
#include "mhb/response/response.h"

/* Append the solution the residual was just evaluated at. */
shb_status mhb_record(mhb_response *response, int branch, mhb_balance *residual,
                      const mhb_curve_point *point, int special, double seconds);

/* The motion recorded at a point as unknowns x of a residual; harmonics that were not recorded are 0. */
void mhb_recorded_motion(const mhb_branch *branch, int point, const mhb_balance *residual,
                         double *x);

#endif
