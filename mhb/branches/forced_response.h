/* The whole forced response: linear limits and one branch a preload, in parallel over preloads, published as it grows. */
#ifndef MHB_BRANCHES_FORCED_RESPONSE_H
#define MHB_BRANCHES_FORCED_RESPONSE_H

#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"

/* Solve and, unless path is NULL, publish to path: at branch ends (once a second at most), every 10 s, at the end, and when interrupted.
 * settings->motion_tolerance > 0: harmonics are chosen at each point (harmonic_selection.h), settings->harmonics does not count.
 * settings->resume: branches that an earlier file of the same settings holds complete are not computed again.
 *   response  out  the caller destroys it (NULL on error)
 * Returns SHB_OK; SHB_NOT_CONVERGED if a branch ended before the range was covered; SHB_INTERRUPTED; SHB_ERR_*. */
shb_status mhb_forced_response(const modal_model *model, const mhb_settings *settings,
                               const char *path, const shb_provenance *provenance,
                               shb_progress *progress, mhb_response **response);

#endif
