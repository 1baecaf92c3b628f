/* One multiplier near the unit circle, followed from solution to solution: the test function of
 * flips and Neimark-Sacker points (docs/theory/tracking.md).
 *
 * It is followed as an eigenvalue lambda of one Bloch problem (bloch.h), at fixed sub-steps. Where
 * that problem is real there are two kinds:
 *   pair  lambda and its conjugate, by their product p: g = p^(s/2) - 1, s the segments of a
 *         period. p and the discriminant are smooth where the pair meets on the real axis.
 *   real  lambda = +1 or -1 =: c, by the two eigenvalues nearest to c:
 *         g = -s (c lambda_1 - 1)(c lambda_2 - 1)/max(|c lambda_2 - 1|, 0.1),
 *         which is smooth also where both meet.
 * Elsewhere lambda is one complex number, g = |lambda|^s - 1. */
#ifndef MHB_FLOQUET_FOLLOWED_MULTIPLIER_H
#define MHB_FLOQUET_FOLLOWED_MULTIPLIER_H

#include "mhb/floquet/floquet.h"

typedef struct {
  int  wave;       /* of its Bloch problem */
  int  sign;       /* of a real lambda, +1 or -1; 0: complex */
  int  refinement; /* of the sub-steps */
  bool keep;       /* their number between transitions is that of the last call */
} mhb_followed_multiplier;

/* What it is at a solution. */
typedef struct {
  double         g;            /* 0 on the unit circle, positive outside */
  double         half_sum;     /* of a pair, smooth as the discriminant is */
  double         discriminant; /* of a pair: ((lambda_1 - lambda_2)/2)^2, positive where both are
                                  real; else negative */
  double complex lambda;       /* of a pair with the imaginary part not below 0 */
  double complex multiplier;
} mhb_multiplier_place;

/* Choose, at a solution, the strongest multiplier that is not on the positive axis. It crosses the
 * circle at a flip or a Neimark-Sacker point.
 *   flip   in   a real one is wanted, else a complex one
 * Returns NULL, or the reason why there is none. */
const char *mhb_followed_multiplier_choose(mhb_floquet *floquet, const mhb_solution *solution,
                                           bool flip, mhb_followed_multiplier *followed,
                                           mhb_multiplier_place *place);

/* Find it at another solution.
 *   near  in   lambda as expected there, of which it is the nearest; not used for a real one
 * Returns NULL, or the reason of a failure: also where two eigenvalues are equally near. */
const char *mhb_followed_multiplier_find(mhb_floquet *floquet, const mhb_solution *solution,
                                         const mhb_followed_multiplier *followed,
                                         double complex near, mhb_multiplier_place *place);

#endif
