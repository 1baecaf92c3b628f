/* Error of a solution by the modes that the modal file leaves out.
 *
 * Residual terms and modes leave out a part dR_k of the receptance and d(free)_k of the load's
 * response. Their size is estimated (modal/model/residual_series.h); their shape is that of the
 * last residual term of the file. The residual terms have no damping. What is lost by it is
 * estimated from the damping of the modes kept and the first two residual terms. At given forces
 * the motion lacks e_k = d(free)_k - dR_k p_k, with the signs of both. The contact answers to it:
 *   (I + R J) du = e,   J = dp/du,
 * near a resonance of the blade with its contact many times e. The answer to the difference of the
 * last two shapes is added to |du|. The true shape is nearer to the last one than that is to the
 * one before. Near a fold this du is far too long; a long one is shortened by the curvature of the
 * residual along it. */
#ifndef MHB_BALANCE_MODAL_ERROR_H
#define MHB_BALANCE_MODAL_ERROR_H

#include "mhb/balance/truncation_error.h"

/* Estimated |du| of a solution relative to its vibration; -1 if the file has no residual
 * flexibility.
 *   x           in  [n] the solution, point of the balance's evaluation in use
 *   truncation  in  its last estimate was by Newton's step, at x. NULL: with up to 20 pairs, all
 *                   linear, harmonics are solved one by one; otherwise |e| is returned */
double mhb_modal_error(const mhb_balance *balance, const double *x, mhb_truncation *truncation);

#endif
