/* Integrals of the friction force over one period, and the harmonics they give.
 *
 * Stick pieces enter by integrals of the basis, slip pieces by the quadrature of their panels. The
 * derivative columns (internal.h) are carried along. */
#ifndef MHB_CONTACT_FORCE_INTEGRALS_H
#define MHB_CONTACT_FORCE_INTEGRALS_H

#include "mhb/contact/internal.h"

/* All integrals, transitions and shares of the period are emptied. */
void mhb_force_integrals_clear(mhb_contact_evaluator *contact);

/* The lanes of the slip panels are added into f and f_slider. */
void mhb_force_integrals_collect(mhb_contact_evaluator *contact);

/* The stick pieces are added, and all is normalised. f [2][nf] and J [2][nf][stride] are then the
 * Fourier coefficients of friction and of its derivative, in units of the force scale. */
void mhb_force_integrals_finish(mhb_contact_evaluator *contact);

/* Factor from the integral of b_i x over a period to the Fourier coefficient i of x. */
double mhb_force_integrals_factor(int i);

/* In a recorded lap: keeps the transition at phase t (rad) into state, as far as there is room. */
void mhb_note_transition(mhb_contact_evaluator *contact, double t, mhb_state state);

#endif
