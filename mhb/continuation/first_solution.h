/* The first solution of a curve. */
#ifndef MHB_CONTINUATION_FIRST_SOLUTION_H
#define MHB_CONTINUATION_FIRST_SOLUTION_H

#include "mhb/balance/newton.h"

/* A solution at a value of the parameter, without a guess. Newton's method starts from the open and
 * the stuck limit, and from zero. Then it follows the preload from both sides, and the frequency
 * from values near by.
 *   value       in   of the balance's parameter
 *   tolerance   in   of |r|/|x|
 *   x           out  [n] m
 *   iterations  out  of the last Newton method
 * The parameter and the preload of the balance are left as they were. */
mhb_reason mhb_first_solution(mhb_newton *newton, mhb_balance *balance, double value,
                              double tolerance, double *x, int *iterations);

#endif
