/* Newton's method on the balance of harmonics at a fixed value of the parameter, with a line search. */
#ifndef MHB_BALANCE_NEWTON_H
#define MHB_BALANCE_NEWTON_H

#include "mhb/balance/condensation.h"
#include "mhb/numerics/vector.h"

/* Why it stopped: > 0 converged. */
typedef enum {
  MHB_CONVERGED      = 1,
  MHB_NO_DESCENT     = -1, /* the line search found no decrease */
  MHB_MAX_ITERATIONS = -2,
  MHB_SINGULAR       = -3
} mhb_reason;

const char *mhb_reason_text(mhb_reason reason);

/* Arrays for systems of n unknowns, made once. */
typedef struct {
  int               n;
  mhb_condensation *system;                         /* of the residual last bound; NULL before */
  double           *r, *step, *trial, *slope, *row; /* [n+1] */
} mhb_newton;

shb_status mhb_newton_create(int n, mhb_newton **newton);
void       mhb_newton_destroy(mhb_newton *newton);

/* Make the linear system of a residual of n unknowns, unless it is there. SHB_ERR_IO: no memory. */
shb_status mhb_newton_bind(mhb_newton *newton, const mhb_balance *residual);

/* Solve r(x, value) = 0 from x: |r| <= tolerance max(|x|, floor). *iterations counts Newton steps. */
mhb_reason mhb_newton_solve(mhb_newton *newton, mhb_balance *residual, double value,
                            double tolerance, double *x, int *iterations);

#endif
