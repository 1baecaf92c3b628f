/* The exact derivative of friction by the motion: forward sensitivities along one period
 * (docs/theory/contact.md, Exact sensitivities). All functions heed contact->mode. */
#ifndef MHB_CONTACT_SENSITIVITY_H
#define MHB_CONTACT_SENSITIVITY_H

#include "mhb/contact/internal.h"

/* T = Z = 0: the start of a lap. */
void mhb_sensitivity_clear(mhb_contact_evaluator *contact);

/* Stick to slip at phase t, direction theta, |f| = mu n. Z -> T. */
void mhb_sensitivity_stick_to_slip(mhb_contact_evaluator *contact, double t, double theta,
                                   double n);

/* Slip to stick. T -> Z. */
void mhb_sensitivity_slip_to_stick(mhb_contact_evaluator *contact, double t, double theta,
                                   double n);

/* Closing at t into state, with direction theta if that is slip: sets Z or T. */
void mhb_sensitivity_closing(mhb_contact_evaluator *contact, double t, mhb_state state,
                             double theta);

/* T through contact->panel and, in a recorded lap, the panel's part of the integrals. */
void mhb_sensitivity_panel(mhb_contact_evaluator *contact);

/* The part of a stick piece, whose integrals of the basis are contact->basis_integrals. */
void mhb_sensitivity_stick(mhb_contact_evaluator *contact);

/* |DP|: the factor by which a lap contracts a change of the slider. */
double mhb_sensitivity_contraction(const mhb_contact_evaluator *contact);

/* Error of the periodic slider due to rounding, in units of the friction. A lap is good to some
 * 4e-13, its fixed point to that divided by det(I - DP). Where slip just begins, a double root,
 * that is the square root of the error of a lap. */
double mhb_sensitivity_roundoff(const mhb_contact_evaluator *contact);

/* Newton step of the periodic slider: dz = (I - DP)^-1 r, r = P(z) - z. |det(I - DP)| is held above
 * 1e-12. */
void mhb_sensitivity_close(const mhb_contact_evaluator *contact, const double r[2], double dz[2]);

/* J += the derivative by way of the periodic slider. |det(I - DP)| is held above 1e-7. */
void mhb_sensitivity_eliminate_slider(mhb_contact_evaluator *contact);

#endif
