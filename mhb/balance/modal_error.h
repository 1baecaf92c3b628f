/* What the modes left out of the modal file do to a solution.
 *
 * Residual terms and modes leave a part dR_k of the receptance out, and the same of the load's response. Its size is estimated (modal/model/residual_series.h); its
 * shape is taken to be that of the last term that is held. The motion lacks e_k = d(load)_k - dR_k p_k at given forces; as the contact answers,
 *   (I + R J) du = e,   J = dp/du:
 * near a resonance of the blade with its contact that is many times e. */
#ifndef MHB_BALANCE_MODAL_ERROR_H
#define MHB_BALANCE_MODAL_ERROR_H

#include "mhb/balance/condensation.h"

/* Estimated |du| of the solution x[n] that the balance was just evaluated at, relative to its vibration; -1 if the file holds no residual flexibility.
 *   system  in  the linearised balance, factored at x, of as many harmonics or more; NULL: where every pair is open or stuck harmonics are
 *               solved one by one (up to 20 pairs), elsewhere |e| itself is given */
double mhb_modal_error(const mhb_balance *balance, const double *x, mhb_condensation *system);

#endif
