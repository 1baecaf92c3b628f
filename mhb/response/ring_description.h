/* Which motion of a ring a branch has, in words (mhb/search/ring_motion.h has the measures). */
#ifndef MHB_RESPONSE_RING_DESCRIPTION_H
#define MHB_RESPONSE_RING_DESCRIPTION_H

#include "mhb/response/response_types.h"

/* "wave", "other waves", "standing wave", "localised"; "at rest". */
const char *mhb_ring_kind_name(int kind);

/* The point where the fewest blades take part; of equal ones the first. -1: no ring, or none
 * known. */
int mhb_ring_most_localised(const mhb_response *response, const mhb_branch *branch);

enum { MHB_RING_TEXT = 160 };

/* "localised: 2.1 of 6 blades take part, 0.34 of the energy in the wave of the load", at that
 * point; else "". */
void mhb_ring_describe(const mhb_response *response, const mhb_branch *branch,
                       char text[MHB_RING_TEXT]);

#endif
