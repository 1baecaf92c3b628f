/* The slider's way through one period of stick and slip, from event to event. */
#ifndef MHB_CONTACT_SLIDER_H
#define MHB_CONTACT_SLIDER_H

#include "mhb/contact/internal.h"

/* Friction over the closed intervals, every closing a fresh start (eqs. 13-15). 0: a panel
 * failed. */
int mhb_slider_with_openings(mhb_contact_evaluator *contact);

/* Friction of a contact that stays closed and slips: the fixed point of the lap map P(z) = z by
 * Newton's method from z. 0: not reached.
 *   near  in     z is the slider of a motion nearby
 *   z     inout  slider at phase 0, in units of the force scale */
int mhb_slider_periodic(mhb_contact_evaluator *contact, int near, double z[2]);

#endif
