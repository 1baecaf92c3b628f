/* Pairs in a linear state. A stuck pair is a spring S = diag(kv, Ku), at k = 0 diag(kv, 0); an open
 * one has no force. */
#ifndef MHB_BALANCE_STICK_STIFFNESS_H
#define MHB_BALANCE_STICK_STIFFNESS_H

#include <complex.h>

#include "mhb/contact/law.h"

/* Class of a pair's Jacobian dp/du. */
typedef enum {
  MHB_PAIR_NONLINEAR, /* the pair slips or opens for a part of the period */
  MHB_PAIR_STUCK,     /* diag(kv, Ku) at each harmonic k > 0, diag(kv, 0) at k = 0 */
  MHB_PAIR_AT_LIMIT,  /* as stuck, but the mean friction depends on all harmonics of u */
  MHB_PAIR_OPEN       /* 0 */
} mhb_pair_kind;

/* p[3] = S x of a stuck pair at harmonic k. */
static inline void mhb_stick_force(const mhb_law *law, int k, const double complex x[3],
                                   double complex p[3]) {
  p[0] = law->kv * x[0];
  p[1] = k ? law->ku[0] * x[1] + law->ku[1] * x[2] : 0;
  p[2] = k ? law->ku[1] * x[1] + law->ku[2] * x[2] : 0;
}

/* A[3 pairs][3 pairs] <- I + R_k S, column-major, with S of the pairs whose kind is stuck.
 *   law, kind  in  [pairs]
 *   R          in  [3 pairs][3 pairs] receptance of harmonic k, m/N */
void mhb_stick_matrix(int n_pairs, const mhb_law *law, const mhb_pair_kind *kind, int k,
                      const double complex *R, double complex *A);

#endif
