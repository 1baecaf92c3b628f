/* One branch of the response: followed over the frequency range at one preload, folds and peaks located, each point
 * recorded with its forces, states and error estimates. */
#ifndef MHB_BRANCHES_MAIN_BRANCH_H
#define MHB_BRANCHES_MAIN_BRANCH_H

#include <stdbool.h>

#include "mhb/branches/monitor.h"
#include "mhb/response/response.h"

/* Branches at most that mhb_trace_main_branch appends: the response needs room reserved for them. */
enum { MHB_MAX_DETACHED = 4 };

/* Follow the branch at the residual's preload from the low to the high end of the range. A curve that closes or leaves by the low
 * end becomes a branch of its own (MHB_FROM_DETACHED), and what reaches the high end is followed from beyond it, both ways; so is a curve that
 * was lost. Never fails for want of convergence: the branch then ends with its reason. Errors: SHB_ERR_IO no memory. */
shb_status mhb_trace_main_branch(mhb_balance *residual, mhb_response *response, int branch,
                                 mhb_monitor *monitor);

/* Where a further branch begins. */
typedef struct {
  const double *x; /* [n] m, of the residual: a solution at a value of the parameter */
  double        value;
  const double *along; /* [n] NULL; or x lies on another curve, which the branch leaves this way */
} mhb_start;

/* Follow the branch through a solution both ways until the curve closes, leaves the range or joins one of lower order; the points
 * are in order along it. It is complete if one of these happened. A branch that leaves
 * another one must be on its way already: *none tells that there was no such branch, and nothing is recorded. Errors: as above. */
shb_status mhb_trace_branch(mhb_balance *residual, mhb_response *response, int branch,
                            mhb_monitor *monitor, const mhb_start *start, bool *none);

#endif
