/* The linear limits: contact open everywhere, stuck everywhere. */
#ifndef MHB_BRANCHES_LINEAR_LIMITS_H
#define MHB_BRANCHES_LINEAR_LIMITS_H

#include "mhb/balance/balance.h"
#include "mhb/response/response.h"

/* The open or stuck limit, by the kind of the branch. Its natural frequencies are points. It is
 * sampled until linear interpolation of every output is within 0.2 % of its local value. */
shb_status mhb_linear_limits(mhb_balance *balance, mhb_response *response, int branch);

#endif
