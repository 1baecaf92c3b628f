/* Contacts so stiff that the blade cannot tell them from rigid ones. */
#ifndef MHB_STRUCTURE_STIFFNESS_CHECK_H
#define MHB_STRUCTURE_STIFFNESS_CHECK_H

#include "mhb/structure/receptance.h"

/* The most that a contact may be stiffer than the blade at it. */
#define MHB_STIFFNESS_LIMIT 1e7

/* Compares a pair's share of kuu, kww and kv (or the end of the range that is followed) with the blade's own stiffness there,
 * 1/R at no frequency. The law itself is as exact and as fast at any stiffness: its force tends to that of a rigid contact, off
 * by 1/(k R). But a curve then bends within motions of mu n/k, and has to be followed through them: from a second (1e3 times) to
 * minutes (1e9 times). Moves the receptance. SHB_ERR_INPUT: beyond MHB_STIFFNESS_LIMIT. */
shb_status mhb_stiffness_check(mhb_receptance *receptance, const mhb_settings *settings);

#endif
