/* A ring of different blades as one modal model with dense shapes.
 *
 * One sector that meets itself: pair a of contact b has the right face of blade b and the left face
 * of blade b + 1. Every program for one blade takes it, with settings of one blade and engine order
 * 0. Cost and memory grow with the square of the number of blades. Time integration uses it, which
 * checks the balance and shares none of its blocks. */
#ifndef MHB_MISTUNING_DENSE_RING_H
#define MHB_MISTUNING_DENSE_RING_H

#include "mhb/mistuning/mistuned_ring.h"

/* model is zeroed before, and freed by modal_model_free. */
void mhb_dense_ring(const mhb_mistuned_ring *ring, modal_model *model);

/* The settings of that model: one blade, engine order 0, as many contacts as the ring has
 * blades. */
void mhb_dense_ring_settings(const mhb_settings *settings, mhb_settings *own);

#endif
