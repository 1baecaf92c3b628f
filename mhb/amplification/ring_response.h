/* The forced response of a ring of different blades, with its amplification factors. */
#ifndef MHB_AMPLIFICATION_RING_RESPONSE_H
#define MHB_AMPLIFICATION_RING_RESPONSE_H

#include "mesh/base/progress.h"
#include "mhb/response/response.h"

/* As mhb_forced_response of settings->ring->whole. Then the peaks of each main curve and of the
 * tuned ring are found, and the file is written once more. Errors: as mhb_forced_response. */
shb_status mhb_ring_response(const mhb_settings *settings, const char *path,
                             const shb_provenance *provenance, shb_progress *progress,
                             mhb_response **response);

#endif
