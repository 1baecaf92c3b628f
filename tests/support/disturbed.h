/* Time integration of the blade, or of every blade of a ring, from a disturbed periodic solution: an independent witness for
 * multipliers. Small fixed steps, nothing linearised, no events: modes exactly under the mean force of a step, friction by
 * return to the friction circle (first order where it slips), contact with residual flexibility by iteration. */
#ifndef TESTS_SUPPORT_DISTURBED_H
#define TESTS_SUPPORT_DISTURBED_H

#include "mhb/balance/balance.h"

/* State of n = blades (2 modes) + 2 contacts numbers: q [blade][mode], q' likewise, friction [blade][pair][2]. */
typedef struct {
  const modal_model  *model;
  const mhb_settings *settings;
  const mhb_balance  *residual;                          /* at the solution: axes, laws, forces */
  const double       *x;                                 /* the solution */
  double              omega;                             /* rad/s, excitation */
  int                 blades, sides, contacts, n, steps; /* steps a period of the fundamental */
  int                 wave;                              /* E of the fundamental */
  double             *p, *guess;                         /* [3 contacts] now, N */
  double             *u;                                 /* [3 contacts] m */
} disturbed;

/* residual last evaluated at (x, omega). */
void disturbed_create(const modal_model *model, const mhb_settings *settings,
                      const mhb_balance *residual, const double *x, double omega, int steps,
                      disturbed *d);
void disturbed_destroy(disturbed *d);

/* The solution's state at phase 0 of the fundamental; friction from f[pair][2] of blade b at phase -b E/N. */
void disturbed_start(disturbed *d, double *state);

/* Step i of a period, from where the last one ended. */
void disturbed_step(disturbed *d, double *state, int i);

/* One period of the fundamental from phase 0. */
void disturbed_period(disturbed *d, double *state);

/* Multipliers: eigenvalues of the period map's derivative by central differences of relative size. [n] by falling modulus. */
void disturbed_multipliers(disturbed *d, double size, double complex *multiplier);

#endif
