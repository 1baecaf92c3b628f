/* The modal model of one blade of a mistuned ring, free at both contact faces.
 *
 * The shapes are those of the tuned blade, and mode i has the frequency (1 + delta_i) f_i. With one
 * delta for all modes the stiffness is (1 + delta)^2 times the tuned one. Every residual term then
 * follows: R by (1 + delta)^-2, R2 by ^-4, R3 by ^-6, residual modes by their frequencies. Else the
 * terms of the modes left out are those of the tuned blade.
 *
 * The model has twice the pairs, to ground. Pairs 0..P-1 are the right face. Pairs P..2P-1 are the
 * left face with the sign of its motion reversed. The relative motion of pair a between blades b
 * and b + 1 is a sum: motion a of blade b plus motion P + a of blade b + 1. */
#ifndef MHB_MISTUNING_BLADE_MODEL_H
#define MHB_MISTUNING_BLADE_MODEL_H

#include "modal/model/model.h"

/* deviation[n_modes]. lag, rad: of the load's first harmonic; harmonic h lags by h times it. blade
 * is freed by modal_model_free. */
void mhb_blade_model(const modal_model *tuned, const double *deviation, double lag,
                     modal_model *blade);

#endif
