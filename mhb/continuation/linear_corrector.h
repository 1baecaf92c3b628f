/* The balance where every pair stays stuck or open: its harmonics k > 0 know nothing of each other, nor of the mean friction,
 *
 *   u_k(omega) = A_k^-1 free_k,   A_k = I + R_k S,   du_k/domega = A_k^-1 d(free_k - R_k p_k)/domega at p_k = S u_k
 * (S = diag(kv, Ku) of the stuck pairs), zero where no load is. So a point of the path is found without the contact law, but for
 * the means: the mean friction follows the other harmonics, and the mean normal load. */
#ifndef MHB_CONTINUATION_LINEAR_CORRECTOR_H
#define MHB_CONTINUATION_LINEAR_CORRECTOR_H

#include "mhb/balance/balance.h"

typedef struct {
  int             n;     /* 3 pairs */
  double complex *A;     /* [n][n] of one harmonic, factored */
  int            *pivot; /* [n] */
  double complex *u, *p; /* [n] */
  double         *slope; /* [3 pairs nb] dx/domega, real form */
  mhb_pair_kind  *kind;  /* [pairs] noted */
} mhb_linear_corrector;

shb_status mhb_linear_corrector_create(const mhb_balance *residual, mhb_linear_corrector **still);
void       mhb_linear_corrector_destroy(mhb_linear_corrector *still);

/* Note which pairs the residual's last evaluation found stuck, which open. 0: a pair moves, or the path is not one in the
 * frequency. */
int mhb_linear_set_states(mhb_linear_corrector *still, const mhb_balance *residual);

/* Slide (x, omega) within the plane
 *   x_weight normal_x.dx + value_weight normal[n] domega = 0
 * to where the harmonics k > 0 balance, with the pairs as noted; the means stay. 0: no such point; x and omega may then be
 * changed. */
int mhb_linear_correct(mhb_linear_corrector *still, const mhb_balance *residual,
                       const double *normal, double x_weight, double value_weight, double *x,
                       double *omega, int *iterations);

/* A Newton step of the means x_0 alone, at the frequency where the residual r[n] was evaluated last, with derivatives; again: with
 * the derivatives of the last step. 0: singular. */
int mhb_linear_correct_means(mhb_linear_corrector *still, const mhb_balance *residual,
                             const double *r, int again, double *x);

/* Whether the residual's last evaluation found the pairs as noted. */
int mhb_linear_states_hold(const mhb_linear_corrector *still, const mhb_balance *residual);

#endif
