/* Solutions at one value of the parameter that no known branch leads to: a damped Newton method
 * from random starts.
 *
 * A start that ends at a known solution takes some six evaluations. Deflation (Farrell, Birkisson
 * and Funke 2015) was tried. As many of the starts end at new solutions, but all others go on to
 * the last step. They take 130 to 340 evaluations a start, against 17 to 30 without. */
#ifndef MHB_BALANCE_MULTISTART_H
#define MHB_BALANCE_MULTISTART_H

#include <stdbool.h>

#include "mhb/balance/newton.h"

typedef struct {
  int     n, n_solutions, capacity; /* unknowns; solutions in x */
  double *x;                        /* [n_solutions][n] m, those handed in first */
} mhb_solution_set;

void mhb_solution_set_free(mhb_solution_set *set);

/* Add a solution. SHB_ERR_IO: no memory. */
shb_status mhb_solution_set_add(mhb_solution_set *set, int n, const double *x);

/* Add a solution with its copies some periods of the excitation later (subharmonics.h). Copies that
 * are there already are not added again. SHB_ERR_IO: no memory. */
shb_status mhb_solution_set_add_shifts(mhb_solution_set *set, const mhb_balance *balance,
                                       const double *x);

/* Whether x[n] is in the set, to 1e-5 of its size. */
bool mhb_solution_set_has(const mhb_solution_set *set, const double *x);

/* One random start at a value of the balance's parameter.
 *   size    in     m: bound of the fundamental; harmonic k is bounded by size/k^2
 *   seed    inout  decides the start
 *   set     inout  solutions known
 *   x       out    [n] the solution that the start led to
 *   is_new  out    x is a solution that was not in the set; it and its copies now are
 * SHB_ERR_IO: no memory. */
shb_status mhb_multistart_once(mhb_newton *newton, mhb_balance *balance, double value, double size,
                               unsigned long long *seed, mhb_solution_set *set, double *x,
                               bool *is_new);

#endif
