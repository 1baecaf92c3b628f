/* Distance of a solution with m harmonics from that with 2m, without a Jacobian of the latter. It
 * serves rings of different blades, and many pairs.
 *
 * The balance with 2m harmonics is solved by Broyden's method from u. Its first matrix has two
 * parts. Harmonics up to m: the Jacobian with m harmonics. A harmonic k above: I + R_k D alone, D
 * the stiffness of each pair at harmonic m. In a ring R_k is taken contact by contact; with many
 * pairs it is that of the small basis (lone_harmonics.h). Pairs that stick or are open are taken
 * to stay so. It costs about three residuals. */
#ifndef MHB_BALANCE_TRUNCATION_STEP_H
#define MHB_BALANCE_TRUNCATION_STEP_H

#include "mesh/base/arena.h"
#include "mhb/balance/condensation.h"

enum { MHB_MOST_TRUNCATION_STEPS = 5 };

typedef struct {
  const mhb_balance *balance; /* with m harmonics */
  mhb_balance       *doubled; /* with 2m */
  double            *low;     /* [balance->n + 1] */
  double            *at, *r;  /* [doubled->n] */
  double            *steps;   /* [MHB_MOST_TRUNCATION_STEPS][doubled->n] */

  /* a ring */
  mhb_ring_system *factors; /* of the balance, near the point; the caller's */
  double complex  *A;       /* [m][blades][n][n] factors of I + R_k D, n = 3 pairs of a contact */
  int             *pivot;   /* [m][blades][n] */
  double complex  *u;       /* [n] */
  double          *along;   /* [balance->n + 1] solution for the border alone */

  /* many pairs */
  mhb_woodbury   *jacobian; /* of the balance; NULL: a ring */
  mhb_woodbury   *above;    /* of the doubled balance; the caller's */
  mhb_block      *form;     /* [pairs] */
  double complex *D;        /* [pairs][9] */
  shb_arena       arena;
} mhb_truncation_step;

/* Both balances, and the doubled one's `above` of many pairs, must outlive it. SHB_ERR_IO: no
 * memory. */
shb_status mhb_truncation_step_create(const mhb_balance *balance, mhb_balance *doubled,
                                      mhb_woodbury *above, mhb_truncation_step **step);
void       mhb_truncation_step_destroy(mhb_truncation_step *step);

/* step[doubled->n] <- the change of x[doubled->n], which has no harmonics above m. The balance's
 * evaluation in use is linearised near it.
 *   factors   in  of a ring: a system of the balance, factored near it with or without a border
 *   r         in  [doubled->n] the residual at x, or NULL
 *   feedback  in  [doubled->n] what higher harmonics add to the residuals, or NULL
 * 1: step is known to a tenth of its size. 0: it is not, use Newton's step. */
int mhb_truncation_step_find(mhb_truncation_step *step, mhb_ring_system *factors, const double *x,
                             const double *r, const double *feedback, double *out);

/* Harmonics up to m of change[doubled->n] <- (I + R J)^-1 change, by the factors of the last step.
 * Those above stay. 0: it failed. */
int mhb_truncation_step_solve(mhb_truncation_step *step, double *change);

#endif
