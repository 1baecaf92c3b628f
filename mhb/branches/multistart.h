/* Solutions at one value of the parameter that no known branch leads to: a damped Newton method from random starts.
 *
 * A start that comes out at a known solution does so in some six evaluations. Deflation, which keeps it from there, was tried: it
 * makes as many of the starts end at new solutions, but all others wander to the last step, 130 to 340 evaluations a start for 17 to 30 without. */
#ifndef MHB_BRANCHES_MULTISTART_H
#define MHB_BRANCHES_MULTISTART_H

#include <stdbool.h>

#include "mhb/balance/newton.h"

typedef struct {
  int     n, n_solutions, capacity; /* unknowns; solutions in x */
  double *x;                        /* [set][n] m, those handed in first */
} mhb_solution_set;

void mhb_solution_set_free(mhb_solution_set *set);

/* A solution that is known, or has been set. SHB_ERR_IO: no memory. */
shb_status mhb_solution_set_add(mhb_solution_set *set, int n, const double *x);

/* The same, with its copies some periods of the excitation later (subharmonics.h); those that are there already are not added again.
 * SHB_ERR_IO: no memory. */
shb_status mhb_solution_set_add_shifts(mhb_solution_set *set, const mhb_balance *balance,
                                       const double *x);

/* Whether x[n] is there, to 1e-5 of its size. */
bool mhb_solution_set_has(const mhb_solution_set *set, const double *x);

/* One random start of harmonics up to size (m), at a value of the residual's parameter; the seed decides it and moves on.
 *   x       out  [n] what it led to
 *   is_new  out  x is a solution that was not there; it and its shifts now are
 * SHB_ERR_IO: no memory. */
shb_status mhb_multistart_once(mhb_newton *newton, mhb_balance *balance, double value, double size,
                               unsigned long long *seed, mhb_solution_set *set, double *x,
                               bool *is_new);

#endif
