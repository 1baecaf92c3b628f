/* Search for eigenvalues that a block Lanczos run has missed. A second block Lanczos run starts
 * from a random block. It works on the part of T = (K - shift M)^-1 M outside the basis.
 *
 * Q is the basis, and P = 1 - Q Q^T M projects onto the rest. The first run leaves the relation
 * T Q = Q H + R B E^T with the next block R and the last block E of the identity. N counts
 * eigenvalues, and t is no eigenvalue of H. The Schur complement of H - t in T - t (Haynsworth
 * 1968) gives
 *
 *   N(T > t) = N(H > t) + N(G' > t),   G' = P T P - R F' R^T M,   F' = B E^T (H - t)^-1 E B^T.
 *
 * Of F' only the part F of the Ritz values below t is kept. This increases G' to G = P T P + R F
 * R^T M, which is positive semi-definite. If the largest eigenvalue g of G is below t, every
 * eigenvalue of T above t is a Ritz value.
 *
 * Block Lanczos on G bounds g. It starts from a block X of p random columns independent of Q; let x
 * be the largest Ritz value after k steps. Suppose g > t, and let c be the component of its
 * eigenvector in span X. The Chebyshev polynomial of degree k - 1 on [0, x] shows
 *
 *   c^2 <= eta^2 = x / (t - x) / T_{k-1}(2 t/x - 1)^2.
 *
 * For X = diag(M)^-1/2 times normal numbers and order N such a small component has the probability
 *
 *   probability <= (eta^2 N / 2a)^{p/2} / Gamma(p/2 + 1),   a the least eigenvalue of diag(M)^-1 M:
 *
 * c^2 N is at least a times a chi-square variate of p degrees of freedom. For undistorted elements
 * a is at least 0.25 (ten-node tetrahedra) or 0.081 (twenty-node hexahedra); 0.05 is used. For one
 * column the bound is that of Kuczynski, Wozniakowski, SIAM J. Matrix Anal. Appl. 13, 1992. */
#ifndef MODAL_EIGEN_MISSED_MODES_H
#define MODAL_EIGEN_MISSED_MODES_H

#include "modal/eigen/block_basis.h"

typedef enum {
  MODAL_VERDICT_COMPLETE, /* every eigenvalue above t is a Ritz value, up to the probability */
  MODAL_VERDICT_MISSING,  /* an eigenvalue above t is no Ritz value */
  MODAL_VERDICT_UNDECIDED /* undecided after the largest number of steps */
} modal_verdict;

typedef struct {
  modal_verdict verdict;
  int           count;       /* Ritz values above t */
  int           steps;       /* block solves */
  double        probability; /* bound of the probability that one is missing */
  double        ratio;       /* largest Ritz value of G, relative to t */
} modal_missed_modes;

/* Search. b: basis after a converged run, H holding the eigenvectors, theta the Ritz values, W the
 * next block. W is overwritten. */
PetscErrorCode modal_missed_modes_search(const modal_block_basis *b, double t,
                                         modal_missed_modes *out);

/* The bound above; 1 if ratio = x / t is 1 or more. */
double modal_missed_modes_probability(double ratio, int steps, int columns, double order);

#endif
