/* A damped oscillator over a sub-step under a constant force, exactly. */
#ifndef MHB_VARIATION_PROPAGATOR_H
#define MHB_VARIATION_PROPAGATOR_H

#include <math.h>

/* Coefficients over h: change of q by (q, v), v by (q, v), both by a unit force. */
enum { DQ_Q, DQ_V, V_Q, V_V, DQ_P, V_P, PROPAGATOR };

static inline void propagator_set(double w, double zeta, double h, double *e) {
  double a = zeta * w, wd = w * sqrt(1 - zeta * zeta), decay = exp(-a * h);
  double s = sin(wd * h), half = sin(0.5 * wd * h), ratio = s / wd;
  double change = expm1(-a * h) + decay * (a * ratio - 2 * half * half); /* of q by q */
  e[DQ_Q]       = change;
  e[DQ_V]       = decay * ratio;
  e[V_Q]        = -w * w * decay * ratio;
  e[V_V]        = decay * (1 - 2 * half * half - a * ratio);
  e[DQ_P]       = -change / (w * w);
  e[V_P]        = decay * ratio;
}

#endif
