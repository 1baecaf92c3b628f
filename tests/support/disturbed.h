/* Time integration of a blade, or of every blade of a ring, from a disturbed periodic solution. It
 * is an independent reference for multipliers. The steps are small and fixed, without linearisation
 * or events. Modes are exact under the mean force of a step. Friction returns to the friction
 * circle, to first order while it slips. Contact with residual flexibility is solved by
 * iteration. */
#ifndef TESTS_SUPPORT_DISTURBED_H
#define TESTS_SUPPORT_DISTURBED_H

#include "mhb/balance/balance.h"

/* State of blades (2 modes) + 2 contacts numbers: q [blade][mode], q' likewise, friction
 * [blade][pair][2]. */
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

/* The balance must have been evaluated at (x, omega). */
void disturbed_create(const modal_model *model, const mhb_settings *settings,
                      const mhb_balance *residual, const double *x, double omega, int steps,
                      disturbed *d);
void disturbed_destroy(disturbed *d);

/* The state of the solution at phase 0 of the fundamental. Blade b has its friction from f[pair][2]
 * at phase -b E/N. */
void disturbed_start(disturbed *d, double *state);

/* Step i of a period, starting at the end of the last one. */
void disturbed_step(disturbed *d, double *state, int i);

/* One period of the fundamental from phase 0. */
void disturbed_period(disturbed *d, double *state);

/* Multipliers [n] by falling modulus: eigenvalues of the derivative of the period map, by central
 * differences of relative size. */
void disturbed_multipliers(disturbed *d, double size, double complex *multiplier);

#endif
