/* The contacts of a ring that stick or are open leave its system, harmonic by harmonic.
 *
 * Contact i, all of whose pairs stick (q_i = S x_i) or are open (q_i = 0), between the contacts p
 * and n that are next to it:
 *   M x_i + R_ip q_p + R_in q_n = rhs_i,   M = I + R_ii S
 * Its harmonics are not coupled, so M is complex with n = 3 pairs unknowns. Without it
 *   R_pp -= R_pi S M^-1 R_ip,   rhs_p -= R_pi S M^-1 rhs_i,
 * and so on for all pairs of p and n, which become neighbours. What is left is a ring of fewer
 * contacts with the same form. Linear functionals (a border) go along: w_i x_i becomes w_i M^-1
 * rhs_i and a functional of q_p and q_n. The cost is about 18 n^3 complex multiplications a
 * harmonic and contact. That is less than a hundredth of a contact that slips. det M is that of a
 * passive structure: in real form it is positive. */
#ifndef MHB_BALANCE_RING_CONDENSATION_H
#define MHB_BALANCE_RING_CONDENSATION_H

#include <complex.h>
#include <stdbool.h>

#include "mesh/base/arena.h"
#include "mesh/base/status.h"
#include "mhb/balance/stick_stiffness.h"
#include "mhb/structure/ring_receptance.h"

typedef struct {
  const mhb_ring_receptance *ring;
  int                        m, blades, n;  /* harmonics 0..m; n = 3 pairs of a contact */
  const mhb_law             *law;           /* [pairs] of the last factors */
  const mhb_pair_kind       *kind;          /* [pairs] */
  int                        n_gone, *gone; /* [blades] contacts that left, in that order */
  int                       *left;          /* [blades] n_left contacts that did not */
  int                        n_left;
  int *before, *after; /* [blades] next contact that is left; of one that is gone: at its time */

  /* [k][blade][n][n] row-major; of one that is gone: at its time */
  double complex *own, *to_before, *to_after;
  double complex *inverse;                  /* M^-1 */
  double complex *from_before, *from_after; /* R_pi S M^-1, R_ni S M^-1 */
  double complex *work, *rows;              /* [n][n] */
  double complex *force;                    /* [n] */
  int            *pivot;                    /* [n] */
  shb_arena       arena;
} mhb_ring_condensation;

mhb_ring_condensation *mhb_ring_condensation_create(const mhb_ring_receptance *ring, int m);
void                   mhb_ring_condensation_destroy(mhb_ring_condensation *condensation);

/* Whether all pairs of a contact stick or are open. */
bool mhb_ring_contact_is_linear(const mhb_pair_kind *kind, int pairs, int contact);

/* Condense harmonics first..m at the ring's last update. law, kind [pairs] must not change as long
 * as the factors are used. 0: singular. */
int mhb_ring_condensation_factor(mhb_ring_condensation *condensation, const mhb_law *law,
                                 const mhb_pair_kind *kind, int first);

/* Block [n][n] of harmonic k of a contact that is left: own, to_before or to_after. */
static inline double complex *mhb_ring_condensation_at(const mhb_ring_condensation *c,
                                                       double complex *blocks, int k, int contact) {
  const size_t row = (size_t)k * (size_t)c->blades + (size_t)contact;
  return blocks + row * (size_t)c->n * (size_t)c->n;
}

/* One harmonic of a vector [blades n]: x of the contacts left <- the right-hand side without those
 * gone. */
void mhb_ring_condensation_forward(mhb_ring_condensation *c, int k, double complex *x);

/* x of the contacts gone <- the solution. x of those left is the solution, q[blades n] their
 * forces; q of those gone is made. */
void mhb_ring_condensation_backward(mhb_ring_condensation *c, int k, double complex *x,
                                    double complex *q);

/* One harmonic of a functional w[blades n] of x: w of the contacts gone <- that of their right-hand
 * sides. on_force[blades n] <- of the forces of those left. */
void mhb_ring_condensation_functional(mhb_ring_condensation *c, int k, double complex *w,
                                      double complex *on_force);

/* u[3 pairs] <- (I + R_k S)^-1 u where all contacts stick or are open. The blocks of harmonic k are
 * up to date. SHB_ERR_INPUT: the system is singular. */
shb_status mhb_ring_linear_limit(const mhb_ring_receptance *ring, const mhb_law *law, int k,
                                 const mhb_pair_kind *kind, double complex *u);

#endif
