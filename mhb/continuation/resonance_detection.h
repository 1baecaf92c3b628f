/* Resonances that a step would skip.
 *
 * The arclength norm contains the contact motion only, so a lightly coupled mode can be stepped over.
 * A resonance of half-power half width h and of peak P times the rest of the response changes the
 * response, beyond the change along the chord, by
 *   h |dq/domega|/|q| = P h^2/(d^2 + h^2)/|1 + P h/(j d + h)|
 * at a distance d from its place: about P/(1 + P) at its place, and next to nothing where none is. So
 * a step that passes such a place, and is longer than its width, is accepted only after the solution
 * at that place was computed. */
#ifndef MHB_CONTINUATION_RESONANCE_DETECTION_H
#define MHB_CONTINUATION_RESONANCE_DETECTION_H

#include "mhb/continuation/curve.h"
#include "mhb/continuation/linear_resonances.h"

/* Whether the step from current to next, of a balance's curve in the frequency, skips a resonance
 * that is significant in the motion of the contact or of a probe; it is marked so in resonances. A
 * mode whose peak under the forces at next is insignificant is not looked at. */
bool mhb_resonance_skipped(mhb_arclength *curve, mhb_balance *balance,
                           const mhb_resonances *resonances);

#endif
