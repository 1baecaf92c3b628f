/* Peaks of the ring with equal blades: what the amplification factor is relative to. */
#ifndef MHB_AMPLIFICATION_TUNED_PEAKS_H
#define MHB_AMPLIFICATION_TUNED_PEAKS_H

#include "mhb/amplification/ring_peak.h"
#include "modal/model/model.h"

/* peak[preloads] <- of the main curve of each preload of the settings, whose ring is passed over.
 * Where a parameter other than the frequency is followed there is one curve. A curve that does not
 * cover its range has the peak of what there is. Errors: those of mhb_forced_response but
 * SHB_NOT_CONVERGED. */
shb_status mhb_tuned_peaks(const modal_model *tuned, const mhb_settings *settings,
                           mhb_ring_peak *peak);

#endif
