/* Where the motion of doubled period leaves a curve: at a flip. */
#ifndef MHB_BRANCHES_PERIOD_DOUBLING_H
#define MHB_BRANCHES_PERIOD_DOUBLING_H

#include "mhb/balance/balance.h"

/* The way it leaves. At a flip the balance of twice the order is singular among the odd harmonics: of its Jacobian, which by
 * symmetry does not couple odd and even ones at a motion of the lower order, the right singular vector of the smallest value.
 *   x      in   [n] solution of the lower order as one of the residual's, at a value of its parameter
 *   along  out  [n] of length 1, odd harmonics only
 *   *least out  its singular value: the Jacobian without contact is I. Well above 0: what flips has not this wave's form
 * Errors: SHB_ERR_IO no memory. */
shb_status mhb_period_doubling_direction(mhb_balance *balance, const double *x, double value,
                                         double *along, double *least);

#endif
