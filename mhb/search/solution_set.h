/* Solutions that are known at one value of the parameter. */
#ifndef MHB_SEARCH_SOLUTION_SET_H
#define MHB_SEARCH_SOLUTION_SET_H

#include "mhb/balance/balance.h"

typedef struct {
  int     n, n_solutions, capacity; /* unknowns; solutions in x */
  double *x;                        /* [n_solutions][n] m, those handed in first */
} mhb_solution_set;

void mhb_solution_set_free(mhb_solution_set *set);

/* Add a solution. */
void mhb_solution_set_add(mhb_solution_set *set, int n, const double *x);

/* Add a solution with its copies some periods of the excitation later, and some blades further in a
 * ring of equal blades (ring_symmetry.h). They are the same motion. Copies that are there already
 * are not added again. */
void mhb_solution_set_add_copies(mhb_solution_set *set, const mhb_balance *balance,
                                 const double *x);

/* Whether x[n] is in the set, to 1e-5 of its size. */
bool mhb_solution_set_has(const mhb_solution_set *set, const double *x);

#endif
