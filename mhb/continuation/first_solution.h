/* The first solution of a curve. */
#ifndef MHB_CONTINUATION_FIRST_SOLUTION_H
#define MHB_CONTINUATION_FIRST_SOLUTION_H

#include "mhb/balance/newton.h"

/* A solution at a value of the parameter from nothing: the open and stuck limits, zero, then homotopy in the preload from both sides. */
mhb_reason mhb_first_solution(mhb_newton *newton, mhb_balance *balance, double value,
                              double tolerance, double *x, int *iterations);

#endif
