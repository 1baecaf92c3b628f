/* Error of a solution by the modes that the modal file leaves out.
 *
 * Residual terms and modes leave out a part dR_k of the receptance and d(free)_k of the load's
 * response. Their size is estimated (modal/model/residual_series.h); their shape is taken from the
 * last residual term of the file. At given forces the motion lacks e_k = d(free)_k - dR_k p_k. The
 * contact answers to it:
 *   (I + R J) du = e,   J = dp/du,
 * near a resonance of the blade with its contact many times e. */
#ifndef MHB_BALANCE_MODAL_ERROR_H
#define MHB_BALANCE_MODAL_ERROR_H

#include "mhb/balance/condensation.h"

/* Estimated |du| of the solution x[n], the point of the balance's evaluation in use, relative to
 * its vibration; -1 if the file has no residual flexibility.
 *   system  in  condensation factored at x, with as many harmonics or more. NULL: with up to 20
 *               pairs, all linear, harmonics are solved one by one; otherwise |e| is returned */
double mhb_modal_error(const mhb_balance *balance, const double *x, mhb_condensation *system);

#endif
