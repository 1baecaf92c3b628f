/* The linearised balance of a ring of different blades, with a border:
 *
 *   (I + R D) x + column sigma = rhs,   row . x + corner sigma = rhs_border
 *
 * D = dp/du is block-diagonal in the pairs, R block-cyclic (structure/ring_receptance.h). So is the
 * Jacobian: a block of 3 (2m+1) unknowns a pair meets those of both neighbours. Contacts that stick
 * or are open leave it harmonic by harmonic (ring_condensation.h). One factorization by blocks of
 * the others has a cost and memory linear in their number. */
#ifndef MHB_BALANCE_RING_SYSTEM_H
#define MHB_BALANCE_RING_SYSTEM_H

#include "mhb/balance/balance.h"
#include "mhb/balance/ring_condensation.h"
#include "mhb/numerics/block_cyclic.h"

typedef struct {
  const mhb_balance     *balance;
  mhb_ring_condensation *linear;
  mhb_pair_kind         *kind;         /* [pairs] of the last factors */
  mhb_law               *law;          /* [pairs] */
  mhb_block_cyclic      *blocks;       /* of the contacts left; their border is the system's */
  double                *D;            /* [pairs left][3 nb][3 nb] their dp */
  int                    borders;      /* 0 or 1: of the last factors */
  double                 corner;       /* where no contact is left */
  double                *reduced;      /* [n + 1] unknowns of the contacts left */
  double                *line;         /* [2][3 nb] two real rows of R D */
  double complex        *column, *row; /* [k][3 pairs] border of the contacts gone */
  double complex        *x, *q;        /* [k][3 pairs] */
  int                    regular;      /* 1: the last factors can be used */
  shb_arena              arena;
} mhb_ring_system;

/* For the balance of a ring, which must outlive it. */
mhb_ring_system *mhb_ring_system_create(const mhb_balance *balance);
void             mhb_ring_system_destroy(mhb_ring_system *system);

/* Factor at the balance's evaluation in use, which must be a linearisation. column, row: [n + 1]
 * border, both with the same corner last; or both NULL. 0: singular. No allocation. */
int mhb_ring_system_factor(mhb_ring_system *system, const double *column, const double *row);

/* rhs[n or n+1] <- solution. 0: the last factors are singular, or it is not finite. */
int mhb_ring_system_solve(mhb_ring_system *system, double *rhs);

/* Sign of the determinant of the last factors. */
int mhb_ring_system_sign(const mhb_ring_system *system);

#endif
