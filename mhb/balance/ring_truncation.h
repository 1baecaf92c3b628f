/* Distance of a ring's solution with m harmonics from that with 2m, without a Jacobian of the
 * latter.
 *
 * The balance with 2m harmonics is solved by Broyden's method from u. Its first matrix has two
 * parts. Harmonics up to m: the Jacobian with m harmonics, whose factors the curve has. A harmonic
 * k above: I + R_k D contact by contact, D the stiffness of its pairs at harmonic m. Pairs that
 * stick or are open are taken to stay so. It costs about three residuals. */
#ifndef MHB_BALANCE_RING_TRUNCATION_H
#define MHB_BALANCE_RING_TRUNCATION_H

#include "mesh/base/arena.h"
#include "mhb/balance/ring_system.h"

typedef struct {
  const mhb_balance *balance; /* with m harmonics */
  mhb_balance       *doubled; /* with 2m */
  double complex    *A;       /* [m][blades][n][n] factors of I + R_k D, n = 3 pairs of a contact */
  int               *pivot;   /* [m][blades][n] */
  double complex    *u;       /* [n] */
  double            *low;     /* [balance->n + 1] */
  double            *along;   /* [balance->n + 1] solution for the border alone */
  double            *at, *r;  /* [doubled->n] */
  double            *steps;   /* [MHB_MOST_RING_STEPS][doubled->n] */
  shb_arena          arena;
} mhb_ring_truncation;

enum { MHB_MOST_RING_STEPS = 5 };

/* Both balances must outlive it. SHB_ERR_IO: no memory. */
shb_status mhb_ring_truncation_create(const mhb_balance *balance, mhb_balance *doubled,
                                      mhb_ring_truncation **truncation);
void       mhb_ring_truncation_destroy(mhb_ring_truncation *truncation);

/* step[doubled->n] <- the change of x[doubled->n], which has no harmonics above m. The balance's
 * evaluation in use is linearised near it. factors: a system of the balance, factored near it with
 * or without a border. 1: step is known to a tenth of its size. 0: it is not, use Newton's step. */
int mhb_ring_truncation_step(mhb_ring_truncation *truncation, mhb_ring_system *factors,
                             const double *x, double *step);

#endif
