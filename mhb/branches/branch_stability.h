/* Which points of a branch are stable, once it has been followed: Floquet multipliers where they are computed, the parity of
 * folds elsewhere, and the points where a multiplier leaves or enters the unit circle other than at +1.
 *
 * auto: every point where that costs little (up to 60 states, or up to 120 and half a second a branch by the measured cost);
 * else every point where no contact slips, opens or closes, and some others, spread over the curve, as many as half a second
 * allows but at least three; above 120 states a tenth of a second, with fewer modes and sub-steps.
 * A point that is not judged, or whose largest multiplier is at 1 within what can be told, is what the last judged point
 * before it was, changed by every fold in between. Flips and Neimark-Sacker points are located where every point is judged. */
#ifndef MHB_BRANCHES_BRANCH_STABILITY_H
#define MHB_BRANCHES_BRANCH_STABILITY_H

#include "mhb/continuation/arclength.h"
#include "mhb/floquet/floquet.h"
#include "mhb/response/response.h"

/* How a located point gets into the branch at a place; the residual's workspace is at it. */
typedef struct mhb_branch_editor mhb_branch_editor;
struct mhb_branch_editor {
  /* Insert it. Errors: SHB_ERR_IO no memory. */
  shb_status (*insert)(mhb_branch_editor *host, mhb_curve_point *point, int special, int at);
  /* Called before (true) and after (false) the branch's arrays are written. */
  void (*lock)(mhb_branch_editor *host, bool locked);
  /* After each point, locked; false: stop. */
  bool (*point)(mhb_branch_editor *host, double value);
  int stable_at; /* by folds: this point is stable, unless multipliers tell otherwise */
};

typedef struct mhb_branch_stability mhb_branch_stability; /* workspace; one a thread */

/* settings->stability must not be never. Not thread safe (FFTW planner); the residual must outlive it.
 * Errors: SHB_ERR_IO no memory. */
shb_status mhb_branch_stability_create(mhb_balance *residual, mhb_branch_stability **judge);
void       mhb_branch_stability_destroy(mhb_branch_stability *judge);

/* Fill judged, loss, multipliers and stable of a branch, and insert flips and Neimark-Sacker points.
 *   path      its now, next and probe are overwritten
 *   first     [n_first] where the branch begins anew after a gap, ascending; no point is sought across
 *   finished  out  false: the host stopped it; what is not judged yet goes by folds
 * Errors: SHB_ERR_IO no memory. */
shb_status mhb_branch_stability_judge(mhb_branch_stability *judge, mhb_arclength *path,
                                      mhb_response *response, int branch, const int *first,
                                      int n_first, mhb_branch_editor *host, bool *finished);

/* stable and loss by the parity of folds alone, counted from a point that is stable; where the curve left the range and came
 * back to the same end (two points in a row at one value) it has passed another one. */
void mhb_branch_stability_by_folds(mhb_branch *branch, int stable_at);

#endif
