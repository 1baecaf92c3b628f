/* Stability of the points of a branch by their Floquet multipliers. Points where a multiplier
 * crosses the unit circle other than at +1 are located between judged points.
 *
 * With stability: auto the expected cost decides which points are judged.
 *   up to 60 states      every point
 *   more                 every point, if the slipping ones cost 1 s a branch at most
 *   else                 every linear point (no slip, opening or closing), and slipping points as
 *                        many as 1 s allows, at least twelve
 * The first of the latter is the highest point of the first output. The next are the largest
 * motion, peaks, slip onset and both sides of folds, then others by bisection
 * (mhb/floquet/curve_verdicts.h). The cost is computed from the number of states, never measured.
 *
 * Verdicts, and what they rest on (judged):
 *   multipliers  all inside the unit circle, or some outside by more than the margin
 *   marginal     the largest is outside by less: stable, unless the judged points on both sides are
 *                unstable
 *   neighbours   the judged points on both sides are of one kind and near (curve_verdicts.h)
 *   folds        unstable. The number of multipliers beyond +1 changes by one at every fold and
 *                nowhere else, so it is odd here.
 * Other points are not judged: stable is -1. An even number of folds proves nothing, as complex
 * pairs cross the circle without a fold. */
#ifndef MHB_BRANCHES_BRANCH_STABILITY_H
#define MHB_BRANCHES_BRANCH_STABILITY_H

#include "mhb/branches/tracer.h"
#include "mhb/floquet/floquet.h"
#include "mhb/response/response.h"

/* A workspace for multipliers with the sub-steps and dynamic modes that points of a branch get. */
shb_status mhb_branch_floquet_create(mhb_balance *balance, mhb_floquet **floquet);

/* Multipliers at the solution x[n] of the last evaluation of the balance. */
void mhb_branch_floquet_evaluate(mhb_floquet *floquet, const mhb_balance *balance, const double *x,
                                 mhb_multipliers *multipliers);

/* A solution to be judged. */
typedef struct {
  const double *x;     /* [n] */
  double        value; /* of the balance's parameter */
  double        error; /* its truncation error; INFINITY: not known */
} mhb_judged_point;

/* The same with the error of the largest modulus by the harmonics left out, and a verdict that is
 * undecided within it. One routine for branches and studies. truncation: of the balance. */
void mhb_branch_floquet_judge(mhb_floquet *floquet, mhb_balance *balance,
                              mhb_truncation *truncation, const mhb_judged_point *at,
                              mhb_multipliers *multipliers);

/* Bytes of that workspace (mhb_floquet_bytes). */
double mhb_branch_floquet_bytes(int blades, int pairs, int modes, bool mistuned);

typedef struct mhb_branch_stability mhb_branch_stability; /* workspace; one a thread */

/* settings->stability must not be never. The balance must outlive the workspace. */
shb_status mhb_branch_stability_create(mhb_balance *balance, mhb_branch_stability **stability);
void       mhb_branch_stability_destroy(mhb_branch_stability *stability);

/* Fill judged, loss, multipliers and stable of a branch, and insert flips and Neimark-Sacker
 * points.
 *   tracer     its level in use has the balance of the workspace
 *   begins     [n_begins] points at which the branch begins, or begins anew after a gap, rising; no
 *              conclusion is drawn across
 *   finished   out  false: the monitor stopped it before all points were judged
 * The curves so far are published meanwhile. Errors of publication. */
shb_status mhb_branch_stability_judge(mhb_branch_stability *stability, mhb_tracer *tracer,
                                      mhb_response *response, int branch, const int *begins,
                                      int n_begins, bool *finished);

/* Set stable and loss by the parity of folds alone. At stable_at no multiplier is taken to be
 * beyond +1. Points behind an odd number of folds are unstable, all others are not judged.
 *
 * Two points in a row at one value tell that the curve left the range and came back to the same
 * end. It passed another fold there. */
void mhb_branch_stability_by_folds(mhb_branch *branch, const int *begins, int n_begins,
                                   int stable_at);

#endif
