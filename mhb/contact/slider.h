/* The slider's way through one period of stick and slip, from event to event. */
#ifndef MHB_CONTACT_SLIDER_H
#define MHB_CONTACT_SLIDER_H

#include "mhb/contact/internal.h"

/* Friction over the closed intervals, every closing a fresh start (eqs. 13-15). 0: a panel
 * failed. */
int mhb_slider_with_openings(mhb_contact_evaluator *contact);

/* Friction of a contact that stays closed and slips: the fixed point of the lap map P(z) = z by
 * Newton's method from guess. 0: not reached. */
int mhb_slider_periodic(mhb_contact_evaluator *contact, const double guess[2]);

#endif
