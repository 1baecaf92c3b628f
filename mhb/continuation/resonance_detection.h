/* Resonances that a step would skip.
 *
 * The arclength norm contains the contact motion only, so a lightly coupled mode can be stepped
 * over. Let h be half of its half-power width, and P its peak relative to the rest of the response.
 * Within h the response then changes, beyond the change along the chord, by
 *   h |dq/domega|/|q| = P h^2/(d^2 + h^2)/|1 + P h/(j d + h)|
 * at a distance d from its place. That is about P/(1 + P) at the place, and next to nothing where
 * there is no resonance. A step that passes such a place, and is longer than its width, is accepted
 * only after the solution at the place was computed. */
#ifndef MHB_CONTINUATION_RESONANCE_DETECTION_H
#define MHB_CONTINUATION_RESONANCE_DETECTION_H

#include "mhb/continuation/curve.h"
#include "mhb/continuation/linear_resonances.h"

/* Whether the step from current to next skips a significant resonance. The curve is one of the
 * balance in the frequency. Significant means in the motion of the contact or of a probe;
 * resonances notes it. A mode whose peak under the forces at next is insignificant is not solved.
 */
bool mhb_resonance_skipped(mhb_arclength *curve, mhb_balance *balance,
                           const mhb_resonances *resonances);

#endif
