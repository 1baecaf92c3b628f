/* The linear regime: every pair is stuck or open throughout the period.
 *
 * The harmonics k > 0 then decouple from each other and from the static friction:
 *   u_k(omega) = A_k^-1 free_k,   A_k = I + R_k S,   S = diag(kv, Ku) of the stuck pairs,
 *   du_k/domega = A_k^-1 d(free_k - R_k p_k)/domega   at p_k = S u_k,
 * and are zero without a load. They need no contact law. The means do, because the mean friction
 * follows the other harmonics and the mean normal load. */
#ifndef MHB_CONTINUATION_LINEAR_CORRECTOR_H
#define MHB_CONTINUATION_LINEAR_CORRECTOR_H

#include <stdbool.h>

#include "mhb/balance/balance.h"

typedef struct {
  int             n;     /* 3 pairs */
  double complex *A;     /* [n][n] of one harmonic, factored */
  int            *pivot; /* [n] */
  double complex *u, *p; /* [n] */
  double         *slope; /* [3 pairs nb] dx/domega, real form */
  mhb_pair_kind  *kind;  /* [pairs] noted */
} mhb_linear_corrector;

mhb_linear_corrector *mhb_linear_corrector_create(const mhb_balance *balance);
void                  mhb_linear_corrector_destroy(mhb_linear_corrector *linear);

/* Set the regime: which pairs are stuck and which open at a linear evaluation. */
void mhb_linear_set_states(mhb_linear_corrector *linear, const mhb_evaluation *evaluation,
                           int n_pairs);

/* Move (x, omega) within the plane
 *   x_weight normal_x.dx + value_weight normal[n] domega = 0
 * to where the harmonics k > 0 are in balance, with the pairs in the regime. The means stay.
 *   iterations  out  of Newton's method for omega
 * 0: there is no such point; x and omega may be changed then. */
int mhb_linear_correct(mhb_linear_corrector *linear, mhb_balance *balance, const double *normal,
                       double x_weight, double value_weight, double *x, double *omega,
                       int *iterations);

/* A Newton step of the means x_0 alone, at the frequency of the last linearisation.
 *   r      in     [n] residual there
 *   again  in     1: with the derivatives of the last step
 *   x      inout  [n]
 * 0: singular. */
int mhb_linear_correct_means(mhb_linear_corrector *linear, const mhb_balance *balance,
                             const double *r, int again, double *x);

/* Whether the pairs of an evaluation are stuck and open as in the regime. */
bool mhb_linear_states_hold(const mhb_linear_corrector *linear, const mhb_evaluation *evaluation,
                            int n_pairs);

#endif
