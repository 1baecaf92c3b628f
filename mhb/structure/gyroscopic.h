/* Modes that Coriolis forces couple.
 *
 * In the modal coordinates q of the modes at rest the motion obeys
 *   q'' + (D + G) q' + K q = f,   K Hermitian and positive, G skew-Hermitian.
 * q = x e^(j w t) without D and f gives (K + j w G - w^2) x = 0. With K = L L^H and
 * y = (L^H x, w x) that is an ordinary Hermitian problem,
 *   [0, L^H; L, j G] y = w y,
 * so that all 2 n frequencies are real: n positive and n negative ones. Of a travelling wave n the
 * negative ones belong to the opposite wave N - n. Derivation: docs/theory/coriolis.md. */
#ifndef MHB_STRUCTURE_GYROSCOPIC_H
#define MHB_STRUCTURE_GYROSCOPIC_H

#include "modal/model/nodal_diameters.h"

typedef struct {
  int             n;     /* coordinates */
  double         *omega; /* [2n] rad/s, ascending: n negative, n positive */
  double         *decay; /* [2n] 1/s by the damping, to first order */
  double complex *shape; /* [2n][n] x^H K x + w^2 x^H x = 1 */
} mhb_gyroscopic;

/* Solve it.
 *   K     in  [n][n] rad2/s2
 *   G     in  [n][n] 1/s
 *   loss  in  [n] 1/s, the diagonal matrix D
 *   out   out freed by the caller in any case
 * Errors: SHB_NOT_CONVERGED K not positive definite, or no solution. */
shb_status mhb_gyroscopic_solve(int n, const double complex *K, const double complex *G,
                                const double *loss, mhb_gyroscopic *out);

/* The same of the modes kept of a wave. Without Coriolis terms G is zero. */
shb_status mhb_gyroscopic_of_wave(const modal_wave *wave, mhb_gyroscopic *out);

/* Element of the Coriolis matrix of a wave, 1/s; 0 without one. */
double complex mhb_gyroscopic_element(const modal_wave *wave, int i, int j);

void mhb_gyroscopic_free(mhb_gyroscopic *of); /* also on a zeroed struct */

/* Free motion with damping. With W = diag(w_i), K = W^2, the state (W q, q') obeys
 *   (W q, q')' = [0, W; -W, -(D + G)] (W q, q') = V diag(pole) V^-1 (W q, q').
 * The matrix is skew-Hermitian but for D, so that V is well conditioned. With real G the poles are
 * conjugate pairs. */
typedef struct {
  int             n;            /* coordinates */
  double complex *pole;         /* [2n] 1/s: n above the real axis, then n below */
  double complex *to_state;     /* [2n][2n] (q, q') by the amplitudes */
  double complex *to_amplitude; /* [2n][2n] back */
} mhb_damped_modes;

/* Solve it.
 *   omega  in  [n] rad/s, W
 *   loss   in  [n] 1/s, the diagonal matrix D
 *   G      in  [n][n] 1/s
 *   out    out freed by the caller in any case
 * Errors: SHB_ERR_INPUT a mode does not oscillate, or no solution. */
shb_status mhb_damped_modes_solve(int n, const double *omega, const double *loss,
                                  const double complex *G, mhb_damped_modes *out);
void       mhb_damped_modes_free(mhb_damped_modes *of); /* also on a zeroed struct */

#endif
