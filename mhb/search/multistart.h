/* Solutions at one value of the parameter that no known branch leads to: a damped Newton method
 * from random starts.
 *
 * A start that ends at a known solution takes some six evaluations. Deflation (Farrell, Birkisson
 * and Funke 2015) was tried. As many of the starts end at new solutions, but all others go on to
 * the last step. They take 130 to 340 evaluations a start, against 17 to 30 without.
 *
 * In a ring half of the starts are a known motion with a random one at some contacts next to each
 * other. */
#ifndef MHB_SEARCH_MULTISTART_H
#define MHB_SEARCH_MULTISTART_H

#include <stdbool.h>

#include "mhb/balance/newton.h"
#include "mhb/search/solution_set.h"

/* One random start at a value of the balance's parameter.
 *   size    in     m: bound of the fundamental; harmonic k is bounded by size/k^2
 *   seed    inout  decides the start
 *   set     inout  solutions known
 *   x       out    [n] the solution that the start led to
 *   is_new  out    x is a solution that was not in the set; it and its copies now are */
void mhb_multistart_once(mhb_newton *newton, mhb_balance *balance, double value, double size,
                         unsigned long long *seed, mhb_solution_set *set, double *x, bool *is_new);

#endif
