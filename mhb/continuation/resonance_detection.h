/* Resonances that a step would pass over: of a mode that hardly moves the contact, arclength knows nothing.
 *
 * A resonance of half width h and of peak P times what is there otherwise changes the response, over what a step changes along its
 * chord, by
 *   h |dq/domega|/|q| = P h^2/(d^2 + h^2)/|1 + P h/(j d + h)|
 * at a distance d from its place: about P/(1 + P) at it, about nothing where there is none, as where the modes that the contact
 * feels have moved away. So a step that passes a place and is longer than its width is taken once the solution there was looked
 * at. */
#ifndef MHB_CONTINUATION_RESONANCE_DETECTION_H
#define MHB_CONTINUATION_RESONANCE_DETECTION_H

#include "mhb/continuation/arclength.h"

/* Whether a step from now to next passes over a resonance that the contact's or a probe's motion feels; noted in
 * path->resonances. A mode whose peak under the forces at next would be lost in the response is not looked at. Leaves the
 * residual at next, if none is felt. */
int mhb_resonance_skipped(mhb_arclength *path);

#endif
