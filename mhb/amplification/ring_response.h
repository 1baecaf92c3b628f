/* The forced response of a ring of different blades, with its amplification factors. */
#ifndef MHB_AMPLIFICATION_RING_RESPONSE_H
#define MHB_AMPLIFICATION_RING_RESPONSE_H

#include "mhb/amplification/ring_samples.h"

/* As mhb_forced_response of settings->ring->whole. The peaks of each main curve and of the tuned
 * ring follow, then samples unless sampling is NULL. The file is written once more. Samples of an
 * interrupted run with equal settings are taken over. Errors: as mhb_forced_response and
 * mhb_ring_samples. */
shb_status mhb_ring_response(const mhb_settings *settings, const mhb_sampling *sampling,
                             const char *path, const shb_provenance *provenance,
                             shb_progress *progress, mhb_response **response);

#endif
