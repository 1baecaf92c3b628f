/* Newton's method with a line search for the harmonic balance at a fixed value of the parameter. */
#ifndef MHB_BALANCE_NEWTON_H
#define MHB_BALANCE_NEWTON_H

#include "mesh/base/arena.h"
#include "mhb/balance/condensation.h"
#include "mhb/numerics/vector.h"

/* Outcome; positive: converged. */
typedef enum {
  MHB_CONVERGED      = 1,
  MHB_NO_DESCENT     = -1, /* the line search found no decrease of |r| */
  MHB_MAX_ITERATIONS = -2,
  MHB_SINGULAR       = -3, /* the Jacobian */
  MHB_GIVEN_UP       = -4  /* a search reached its bound, or was stopped */
} mhb_reason;

/* Workspace for systems of n unknowns, allocated once. */
typedef struct {
  int               n;
  mhb_condensation *system;                         /* of the balance last bound; NULL before */
  double           *r, *step, *trial, *slope, *row; /* [n+1] */
  bool (*go_on)(const void *context); /* asked before each step; false: give up; NULL: nobody */
  const void *context;
  shb_arena   arena;
} mhb_newton;

mhb_newton *mhb_newton_create(int n);
void        mhb_newton_destroy(mhb_newton *newton);

/* Create the condensation of a balance of n unknowns, unless it is the one bound. */
void mhb_newton_bind(mhb_newton *newton, const mhb_balance *balance);

/* Solve r(x, value) = 0 from x[n]: |r| <= tolerance max(|x|, DBL_MIN).
 *   iterations  out  Newton steps
 * Leaves r and the linearisation at the last x. No allocation once bound. */
mhb_reason mhb_newton_solve(mhb_newton *newton, mhb_balance *balance, double value,
                            double tolerance, double *x, int *iterations);

#endif
