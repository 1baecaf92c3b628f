/* Directions of curves of doubled period: where they leave another curve, at a flip. */
#ifndef MHB_BRANCHES_PERIOD_DOUBLING_H
#define MHB_BRANCHES_PERIOD_DOUBLING_H

#include "mhb/balance/balance.h"

/* At a flip the balance of twice the order is singular among the odd harmonics. At a motion of the
 * lower order its Jacobian does not couple odd and even harmonics, by symmetry. The direction is
 * the right singular vector of the smallest singular value of the odd part.
 *   x       in   [n] solution of the lower order as one of the balance's
 *   value   in   of the balance's parameter
 *   along   out  [n] of length 1, odd harmonics only
 *   *least  out  the singular value. Without contact the Jacobian is I. Well above 0: the flip does
 *                not have the form of the wave */
void mhb_period_doubling_direction(mhb_balance *balance, const double *x, double value,
                                   double *along, double *least);

#endif
