/* Many stuck pairs at many frequencies: (I + R_k S) u = f without making R_k at each.
 *
 * R_k(w) = B L(w) B^H + T(w): modes, and the slow terms of the modes left out. One factor of
 * M = I + T(w0) S, w0 in the middle of the range, serves all frequencies. With W = M^-1 B and
 * G = B^H S W the modes are exact in P = M + B L B^H S:
 *   P^-1 x = M^-1 x - W (L^-1 + G)^-1 B^H S M^-1 x                       (Woodbury)
 * Iterative refinement u += P^-1 (f - (I + R_k S) u) ends on the exact solution. It converges with
 * the ratio of (T(w) - T(w0)) S, about (w/w_r)^2, w_r the first mode left out. A frequency costs a
 * few products of order n^2 in place of n^2 modes for R_k and n^3 for its factor. */
#ifndef MHB_BALANCE_STUCK_SOLVER_H
#define MHB_BALANCE_STUCK_SOLVER_H

#include <stdbool.h>

#include "mhb/balance/stick_stiffness.h"
#include "mhb/low_rank/receptance_product.h"

typedef struct mhb_stuck_solver mhb_stuck_solver;

/* For harmonics 0 to top of a product, which must outlive it. */
mhb_stuck_solver *mhb_stuck_solver_create(mhb_receptance_product *product, int top);
void              mhb_stuck_solver_destroy(mhb_stuck_solver *solver);

/* u[n] <- (I + R_k S)^-1 u at the frequency of the receptance, whose load of harmonic k is up to
 * date; R_k is not needed.
 *   middle     in  rad/s, of w0: always the same, so that results do not depend on the order
 *   law, kind  in  [pairs]; the factor is made anew where stiffness or kind differ from the last
 * false: singular, or not converged; u is then as before. */
bool mhb_stuck_solver_solve(mhb_stuck_solver *solver, int k, double middle, const mhb_law *law,
                            const mhb_pair_kind *kind, double complex *u);

#endif
