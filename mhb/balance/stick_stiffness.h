/* Pairs in a linear state. A stuck pair is a spring S = diag(kv, Ku), at k = 0 diag(kv, 0); an open
 * one has no force. */
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

/* A[3 pairs][3 pairs] <- I + R_k S, column-major, with S of the pairs whose kind is stuck. Harmonic
 * k of the receptance must be up to date. */
void mhb_stick_matrix(const mhb_balance *balance, int k, const mhb_pair_kind *kind,
                      double complex *A);

/* Whether every pair of the evaluation in use is stuck or open over the whole period: the forces
 * then have the harmonics of the motion and no others. */
bool mhb_all_pairs_linear(const mhb_balance *balance);

#endif
