/* Penalty stiffnesses so large that a contact is rigid for every purpose. */
#ifndef MHB_STRUCTURE_STIFFNESS_CHECK_H
#define MHB_STRUCTURE_STIFFNESS_CHECK_H

#include "mhb/structure/receptance.h"

/* Largest ratio of contact stiffness to that of the blade, with its inertia, at the contact. */
#define MHB_STIFFNESS_LIMIT 1e7

/* Compares a pair's share of kuu, kww and kv with the blade's own stiffness 1/R there. The inertia
 * of each mode at the lowest frequency asked for counts as stiffness, m w^2 of a free body. A
 * contact stiffness that is followed counts with the highest value of its range.
 *
 * The law is as exact and as fast at any stiffness. Its force tends to that of a rigid contact,
 * with an error of 1/(k R). But a curve then bends within motions of mu n/k. It has to be followed
 * through them. This takes a second at 1e3 times the blade's stiffness, and minutes at 1e9 times.
 *
 * Sets the frequency of the receptance. SHB_ERR_INPUT: beyond MHB_STIFFNESS_LIMIT. */
shb_status mhb_stiffness_check(mhb_receptance *receptance, const mhb_settings *settings);

#endif
