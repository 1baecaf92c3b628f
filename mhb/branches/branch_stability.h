/* Stability of the points of a branch. It rests on Floquet multipliers where they are computed, and
 * on the parity of folds elsewhere. Points where a multiplier crosses the unit circle other than at
 * +1 are located.
 *
 * With stability: auto the expected cost decides which points are judged by multipliers.
 *   up to 60 states    every point
 *   up to 120 states   every point, if half a second a branch suffices
 *   else               every linear point (no slip, opening or closing), and others spread over the
 *                      curve: as many as half a second allows, and at least three
 *   above 120 states   a tenth of a second, with fewer modes and sub-steps
 *
 * Other points take the verdict of the last judged point before them, changed by every fold in
 * between. So do points whose largest multiplier is 1 within its error. Flips and Neimark-Sacker
 * points are located where every point is judged. */
#ifndef MHB_BRANCHES_BRANCH_STABILITY_H
#define MHB_BRANCHES_BRANCH_STABILITY_H

#include "mhb/branches/tracer.h"
#include "mhb/response/response.h"

typedef struct mhb_branch_stability mhb_branch_stability; /* workspace; one a thread */

/* settings->stability must not be never. The balance must outlive the workspace. SHB_ERR_IO: no
 * memory. */
shb_status mhb_branch_stability_create(mhb_balance *balance, mhb_branch_stability **stability);
void       mhb_branch_stability_destroy(mhb_branch_stability *stability);

/* Fill judged, loss, multipliers and stable of a branch, and insert flips and Neimark-Sacker
 * points.
 *   tracer     its level in use has the balance of the workspace
 *   begins     [n_begins] points at which the branch begins, or begins anew after a gap, rising; no
 *              bifurcation is located across
 *   stable_at  this point is stable by folds, unless multipliers tell otherwise
 *   finished   out  false: the monitor stopped it; points not judged yet go by folds
 * The curves so far are published meanwhile. SHB_ERR_IO: no memory; and errors of publication. */
shb_status mhb_branch_stability_judge(mhb_branch_stability *stability, mhb_tracer *tracer,
                                      mhb_response *response, int branch, const int *begins,
                                      int n_begins, int stable_at, bool *finished);

/* Set stable and loss by the parity of folds alone, counted from a point that is stable. Two points
 * in a row at one value tell that the curve left the range and came back to the same end. It passed
 * another fold there. */
void mhb_branch_stability_by_folds(mhb_branch *branch, int stable_at);

#endif
