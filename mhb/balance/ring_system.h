/* The linearised balance of a ring of different blades, with a border:
 *
 *   (I + R D) x + column sigma = rhs,   row . x + corner sigma = rhs_border
 *
 * D = dp/du is block-diagonal in the pairs, R block-cyclic (structure/ring_receptance.h). So is the
 * Jacobian: a block of 3 (2m+1) unknowns a pair meets those of both neighbours. One factorization
 * by blocks has a cost and memory linear in the number of blades. */
#ifndef MHB_BALANCE_RING_SYSTEM_H
#define MHB_BALANCE_RING_SYSTEM_H

#include "mhb/balance/balance.h"
#include "mhb/numerics/block_cyclic.h"

typedef struct {
  const mhb_balance *balance;
  mhb_block_cyclic  *blocks;
  double            *row;     /* [2][3 nb] two real rows of R D */
  int                regular; /* 1: the last factors can be used */
  shb_arena          arena;
} mhb_ring_system;

/* For the balance of a ring, which must outlive it. SHB_ERR_IO: no memory. */
shb_status mhb_ring_system_create(const mhb_balance *balance, mhb_ring_system **system);
void       mhb_ring_system_destroy(mhb_ring_system *system);

/* Factor at the balance's evaluation in use, which must be a linearisation. column, row: [n + 1]
 * border, both with the same corner last; or both NULL. 0: singular. No allocation. */
int mhb_ring_system_factor(mhb_ring_system *system, const double *column, const double *row);

/* rhs[n or n+1] <- solution. 0: not finite. */
int mhb_ring_system_solve(mhb_ring_system *system, double *rhs);

/* Sign of the determinant of the last factors. */
int mhb_ring_system_sign(const mhb_ring_system *system);

#endif
