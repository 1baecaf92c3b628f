/* How the answer of the blade changes with its model, in a run-up: what dB, dF, the residual terms and dA (mhb/structure/speed_model.h) add to d/d omega. */
#ifndef MHB_STRUCTURE_SPEED_DERIVATIVE_H
#define MHB_STRUCTURE_SPEED_DERIVATIVE_H

#include "mhb/structure/receptance.h"

/* slope[n] += what changes with the model in harmonic k of [free - R p] at fixed p[n]. */
void mhb_speed_derivative_slope(const mhb_receptance *receptance, int k, const double complex *p,
                                double complex *slope);

/* change[3 q] += d_omega times the same of the probes. */
void mhb_speed_derivative_probe(const mhb_receptance *receptance, int k, const double complex *p,
                                double d_omega, double complex *change);

#endif
