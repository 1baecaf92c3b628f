/* Has a block Lanczos run missed an eigenvalue? What its basis leaves out of T = (K - shift M)^-1 M is searched from a random block.
 *
 * Q the basis, P = 1 - Q Q^T M, T Q = Q H + R B E^T (R the next block, E the last block of the identity), t no eigenvalue of H.
 * The Schur complement of H - t in T - t (Haynsworth) gives, N counting eigenvalues,
 *
 *     N(T > t) = N(H > t) + N(G' > t),   G' = P T P - R F' R^T M,   F' = B E^T (H - t)^-1 E B^T.
 *
 * Of F' only the part of the Ritz values below t is kept, which makes G' greater and positive semidefinite: where the
 * greatest eigenvalue g of that operator G is below t, every eigenvalue of T above t is a Ritz value.
 *
 * g is bounded by block Lanczos with G from a block X of p random columns that know nothing of Q. Its k-th greatest Ritz value is x. If g > t
 * then, v the eigenvector and c the part of v in span X, Chebyshev's polynomial of degree k - 1 on [0, x] shows
 *
 *     c^2 <= eta^2 = x / (t - x) / T_{k-1}(2 t/x - 1)^2,
 *
 * and of so small a part the chance is, X = diag(M)^-1/2 times normal numbers and N the order,
 *
 *     chance <= (eta^2 N / 2a)^{p/2} / Gamma(p/2 + 1),   a the least eigenvalue of diag(M)^-1 M:
 *
 * c^2 N is a chi-square variate of p degrees of freedom, times a at least; a >= .25 (ten-node tetrahedra), .081 (twenty-node
 * hexahedra) of undistorted elements, taken as .05. (As Kuczynski, Wozniakowski, SIAM J. Matrix Anal. Appl. 13, 1992, of one column.) */
#ifndef MODAL_EIGEN_MISSED_MODES_H
#define MODAL_EIGEN_MISSED_MODES_H

#include "modal/eigen/block_basis.h"

typedef enum {
  MODAL_VERDICT_COMPLETE, /* every eigenvalue above t is a Ritz value, but for the chance */
  MODAL_VERDICT_MISSING,  /* one is not */
  MODAL_VERDICT_UNDECIDED /* not decided in as many steps as are worth it */
} modal_verdict;

typedef struct {
  modal_verdict verdict;
  int           count;       /* Ritz values above t */
  int           steps;       /* block solves */
  double        probability; /* that an eigenvalue is missing nevertheless, at most */
  double        ratio;       /* the greatest Ritz value of G, to t */
} modal_missed_modes;

/* b: after a run that converged: H holds the eigenvectors, theta the Ritz values, W the next block (it is overwritten). */
PetscErrorCode modal_missed_modes_search(const modal_block_basis *b, double t,
                                         modal_missed_modes *out);

/* The chance above; 1 where ratio = x / t is 1 or more. */
double modal_missed_modes_probability(double ratio, int steps, int columns, double order);

#endif
