/* The main branch of a preload: from the low to the high end of the range. */
#ifndef MHB_BRANCHES_MAIN_BRANCH_H
#define MHB_BRANCHES_MAIN_BRANCH_H

#include "mhb/balance/balance.h"
#include "mhb/response/monitor.h"

/* Trace the branch of a balance at its preload, into branch 0 of a response.
 *
 * A curve that closes, or leaves by the low end, becomes a branch of its own (MHB_FROM_DETACHED),
 * appended to the response. The main branch is then sought beyond it, both ways. The same happens
 * beyond a place where no step converged, which is a gap. Beyond both ends of the range the curve
 * is followed a little, for it may come back. The reason of a branch that does not cover the range
 * is noted in it. */
shb_status mhb_trace_main_branch(mhb_balance *balance, mhb_response *response,
                                 mhb_monitor *monitor);

#endif
