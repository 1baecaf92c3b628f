/* The linearised balance of a ring with 2m harmonics, (I + R D) x = rhs, without its factors.
 *
 * GMRES solves it. Its first matrix has two parts. Harmonics up to m: the factors of the ring with
 * m harmonics near the point. A harmonic k above: I + R_k D of each contact alone, D the stiffness
 * of its pairs at harmonic m. It leaves out what harmonics above m and those below make of each
 * other, and what neighbours feel of the former. */
#ifndef MHB_BALANCE_DOUBLED_RING_H
#define MHB_BALANCE_DOUBLED_RING_H

#include "mesh/base/arena.h"
#include "mhb/balance/ring_system.h"
#include "mhb/low_rank/gmres.h"

typedef struct {
  const mhb_balance *balance; /* with m harmonics */
  const mhb_balance *doubled; /* with 2m */
  mhb_ring_system   *factors; /* of the balance, near the point; the caller's */
  double complex    *A;       /* [m][blades][n][n] factors of I + R_k D, n = 3 pairs of a contact */
  int               *pivot;   /* [m][blades][n] */
  double complex    *u;       /* [n] */
  double            *low;     /* [balance->n + 1] */
  double            *along;   /* [balance->n + 1] solution for the border alone */
  double            *rhs;     /* [doubled->n] */
  double            *p;       /* [doubled->n] D x */
  double complex    *force, *motion; /* [3 pairs] one harmonic */
  mhb_gmres         *gmres;
  shb_arena          arena;
} mhb_doubled_ring;

/* Both balances must outlive it. */
mhb_doubled_ring *mhb_doubled_ring_create(const mhb_balance *balance, const mhb_balance *doubled);
void              mhb_doubled_ring_destroy(mhb_doubled_ring *ring);

/* Factor the first matrix. Both balances' evaluations in use must be linearisations at the same
 * point. Solutions need that of the doubled one.
 *   factors  in  a system of the balance, factored near the point with or without a border, or NULL
 * 0: there is none, or it is singular. */
int mhb_doubled_ring_factor(mhb_doubled_ring *ring, mhb_ring_system *factors);

/* x[doubled->n], the right-hand side, <- the solution with a residual of that tolerance, relative.
 * 0: GMRES does not reach it; x is the best then. */
int mhb_doubled_ring_solve(mhb_doubled_ring *ring, double tolerance, double *x);

/* to[doubled->n] <- (I + R D) x */
void mhb_doubled_ring_product(mhb_doubled_ring *ring, const double *x, double *to);

/* Harmonics up to m of x[doubled->n] <- (I + R D)^-1 x of the balance with m. Those above stay. 0:
 * not finite. */
int mhb_doubled_ring_solve_low(mhb_doubled_ring *ring, double *x);

#endif
