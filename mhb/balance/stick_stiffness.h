/* Contact that stays as it is: a stuck pair is a spring S = diag(kv, Ku), for k = 0 diag(kv, 0), an open one nothing. */
#ifndef MHB_BALANCE_STICK_STIFFNESS_H
#define MHB_BALANCE_STICK_STIFFNESS_H

#include <stdbool.h>

#include "mhb/balance/balance.h"

/* p[3] = S x of a stuck pair at harmonic k. */
static inline void mhb_stick_force(const mhb_law *law, int k, const double complex x[3],
                                   double complex p[3]) {
  p[0] = law->kv * x[0];
  p[1] = k ? law->ku[0] * x[1] + law->ku[1] * x[2] : 0;
  p[2] = k ? law->ku[1] * x[1] + law->ku[2] * x[2] : 0;
}

/* A[n][n] <- I + R_k S, column-major, S of the pairs whose kind is stuck; the receptance's harmonic k must be made. */
void mhb_stick_matrix(const mhb_balance *residual, int k, const mhb_pair_kind *kind,
                      double complex *A);

/* Whether every pair sticks, or is open, throughout, at the point that the residual was evaluated at last: the force has the harmonics of the
 * motion and no others. */
bool mhb_all_pairs_linear(const mhb_balance *residual);

#endif
