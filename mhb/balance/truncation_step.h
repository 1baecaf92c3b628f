/* Distance of a solution with m harmonics from that with 2m, without a Jacobian of the latter.
 *
 * The balance with 2m harmonics is solved by Broyden's method from u. Its first matrix has two
 * parts. Harmonics up to m: the Jacobian with m harmonics. A harmonic k above: I + R_k D alone, D
 * the stiffness of each pair at harmonic m. Many pairs take R_k of the small basis
 * (lone_harmonics.h). Pairs that stick or are open are taken to stay so. It costs three residuals
 * with many pairs, and about eight with few, whose step is asked for more exactly. */
#ifndef MHB_BALANCE_TRUNCATION_STEP_H
#define MHB_BALANCE_TRUNCATION_STEP_H

#include "mesh/base/arena.h"
#include "mhb/balance/condensation.h"

/* Corrections, with many pairs and with few. */
enum { MHB_MOST_TRUNCATION_STEPS = 5, MHB_MOST_STEPS_OF_FEW = 16 };

typedef struct {
  const mhb_balance *balance; /* with m harmonics */
  mhb_balance       *doubled; /* with 2m */
  double            *low;     /* [balance->n] */
  double            *at, *r;  /* [doubled->n] */
  int                most;    /* corrections */
  double            *steps;   /* [most][doubled->n] */

  mhb_woodbury     *jacobian; /* many pairs: of the balance; else NULL */
  mhb_woodbury     *above;    /* of the doubled balance; the caller's */
  mhb_block        *form;     /* [pairs] */
  mhb_condensation *system;   /* few pairs: of the balance; else NULL */
  double complex   *A;        /* [k - m - 1][3 pairs][3 pairs] factors of I + R_k D */
  int              *pivot;    /* [k - m - 1][3 pairs] */
  double complex   *u;        /* [3 pairs] */
  double complex   *D;        /* [pairs][9] */
  shb_arena         arena;
} mhb_truncation_step;

/* Both balances and `above`, of the doubled one, must outlive it; NULL: few pairs. */
mhb_truncation_step *mhb_truncation_step_create(const mhb_balance *balance, mhb_balance *doubled,
                                                mhb_woodbury *above);
void                 mhb_truncation_step_destroy(mhb_truncation_step *step);

/* step[doubled->n] <- the change of x[doubled->n], which has no harmonics above m. The balance's
 * evaluation in use is linearised near it, with few pairs at it.
 *   r         in  [doubled->n] the residual at x
 *   feedback  in  [doubled->n] what higher harmonics add to the residuals, or NULL
 * 1: step is known to a tenth of its size, with few pairs to a hundredth. 0: it is not, use
 * Newton's step. */
int mhb_truncation_step_find(mhb_truncation_step *step, const double *x, const double *r,
                             const double *feedback, double *out);

/* Harmonics up to m of change[doubled->n] <- (I + R J)^-1 change, by the factors of the last step.
 * Those above stay. 0: it failed. */
int mhb_truncation_step_solve(mhb_truncation_step *step, double *change);

#endif
