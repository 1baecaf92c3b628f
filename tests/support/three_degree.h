/* Small modal models with known answers. */
#ifndef TESTS_SUPPORT_THREE_DEGREE_H
#define TESTS_SUPPORT_THREE_DEGREE_H

#include "modal/model/model.h"

/* Contact to ground along the degrees of freedom (v, u, w); the probe is the contact point.
 *   M = I, K = [1 .2 .1; .2 1.3 .15; .1 .15 1.6], C = 0.02 K, F = (0.04, 0.06, 0.03) cos wt */
void three_degree_model(modal_model *model);

/* An oscillator with m = k = 1 and damping ratio zeta. One direction (0 v, 1 u) meets the contact
 * and carries the force F cos wt. */
void one_degree_model(double zeta, int direction, double force, modal_model *model);

/* The same along u with damping ratio 0.01 and force 0.05, and a second mode of omega rad/s. The
 * second mode moves the contact by `contact` and the probe by `probe`, and is driven by `force`. */
void two_mode_model(double omega, double zeta, double contact, double probe, double force,
                    modal_model *model);

/* Cantilever 0.2 x 0.04 x 0.01 m (E 210e9, rho 7800) with 10 flap and 10 edge Euler-Bernoulli modes
 * and damping ratio 0.002. A force F acts along flap at the tip, which meets the contact:
 *   u = cos 40 deg flap - sin 40 deg edge,  v = sin 40 deg flap + cos 40 deg edge */
void tip_contact_beam_model(double force, modal_model *model);

#endif
