/* The solution next to a given one of another balance: other harmonics, modes, accuracy. */
#ifndef MHB_CONTINUATION_NEAREST_SOLUTION_H
#define MHB_CONTINUATION_NEAREST_SOLUTION_H

#include "mhb/balance/newton.h"

/* Newton's method in the plane normal to `normal` through (x, omega), in y = [x/scale, omega/span].
 *
 *   normal  in     [n+1] d(x, omega) along the curve that the solution is compared with; (0, 1): at
 *                  the same frequency
 *   x       inout  [n] m
 *   omega   inout  rad/s
 * Returns 1 if |r| <= tolerance |x| within a distance of 0.5 in y; 1e-8 is enough where round-off
 * prevents less. The balance is then evaluated there. 0 if not; x and omega are then of no use. */
int mhb_nearest_solution(mhb_newton *newton, mhb_balance *balance, const double *normal,
                         double scale, double span, double tolerance, double *x, double *omega);

#endif
