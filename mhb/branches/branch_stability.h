/* Which points of a branch are stable: by Floquet multipliers where they are computed, by the parity
 * of folds elsewhere; and the points where a multiplier crosses the unit circle other than at +1.
 *
 * stability: auto judges every point where that costs little: up to 60 states, or up to 120 states and
 * half a second a branch by the expected cost. Else it judges every point without slip, opening and
 * closing, and some others, spread over the curve: as many as half a second allows, but at least
 * three. Above 120 states that is a tenth of a second, with fewer modes and sub-steps.
 *
 * A point that is not judged, or whose largest multiplier is 1 within its error, takes the verdict of
 * the last judged point before it, changed by every fold in between. Flips and Neimark-Sacker points
 * are located where every point is judged. */
#ifndef MHB_BRANCHES_BRANCH_STABILITY_H
#define MHB_BRANCHES_BRANCH_STABILITY_H

#include "mhb/branches/tracer.h"
#include "mhb/response/response.h"

typedef struct mhb_branch_stability mhb_branch_stability; /* workspace; one a thread */

/* settings->stability must not be never; the balance must outlive it. SHB_ERR_IO: no memory. */
shb_status mhb_branch_stability_create(mhb_balance *balance, mhb_branch_stability **stability);
void       mhb_branch_stability_destroy(mhb_branch_stability *stability);

/* Fill judged, loss, multipliers and stable of a branch, and insert flips and Neimark-Sacker points.
 *   tracer     whose level in use has the balance of the workspace
 *   begins     [n_begins] where the branch begins anew after a gap, rising; no point is sought across
 *   stable_at  by folds: this point is stable, unless multipliers tell otherwise
 *   finished   out  false: the monitor stopped it; points not judged yet go by folds
 * SHB_ERR_IO: no memory. */
shb_status mhb_branch_stability_judge(mhb_branch_stability *stability, mhb_tracer *tracer,
                                      mhb_response *response, int branch, const int *begins,
                                      int n_begins, int stable_at, bool *finished);

/* stable and loss by the parity of folds alone, counted from a point that is stable. Where the curve
 * left the range and came back to the same end (two points in a row at one value) it passed another
 * fold. */
void mhb_branch_stability_by_folds(mhb_branch *branch, int stable_at);

#endif
