/* Small modal models with known answers. */
#ifndef TESTS_SUPPORT_THREE_DEGREE_H
#define TESTS_SUPPORT_THREE_DEGREE_H

#include "modal/model/model.h"

/* M = I, K = [1 .2 .1; .2 1.3 .15; .1 .15 1.6], C = .02 K, F = (.04, .06, .03) cos wt; contact to ground along the
 * degrees of freedom (v, u, w); the probe is the contact point. */
void three_degree_model(modal_model *model);

/* m = k = 1, damping ratio zeta; one direction (0 v, 1 u) meets the contact, force F cos wt on it. */
void one_degree_model(double zeta, int direction, double force, modal_model *model);

/* The same along u at a damping ratio of .01, force .05, and a second mode of omega rad/s that moves the contact by `contact`, the probe
 * by `probe`, and is driven by `force`. */
void two_mode_model(double omega, double zeta, double contact, double probe, double force,
                    modal_model *model);

/* Cantilever .2 x .04 x .01 m (E 210e9, rho 7800), 10 flap and 10 edge Euler-Bernoulli modes, damping ratio .002; the tip meets
 * the contact: u = cos 40 deg flap - sin 40 deg edge, v = sin 40 deg flap + cos 40 deg edge; force F along flap at the tip. */
void tip_contact_beam_model(double force, modal_model *model);

#endif
