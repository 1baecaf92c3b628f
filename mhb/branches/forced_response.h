/* The forced response: linear limits and the branches of each preload, in parallel over preloads.
 */
#ifndef MHB_BRANCHES_FORCED_RESPONSE_H
#define MHB_BRANCHES_FORCED_RESPONSE_H

#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"

/* Solve, and publish to path unless it is NULL. The file is written when a branch ends (once a
 * second at most), every 10 s, at the end, and when interrupted.
 *
 * settings->motion_tolerance > 0: harmonics are chosen at each point (harmonic_selection.h), and
 * settings->harmonics is not used. settings->resume: complete branches of an earlier file of the
 * same settings are not computed again.
 *   response  out  the caller destroys it (NULL on error); unfinished after an interruption, and
 *                  with settings->ring, to which mhb_ring_response adds its peaks
 * Returns SHB_OK, or SHB_NOT_CONVERGED if a branch ended before the range was covered, or
 * SHB_INTERRUPTED, or SHB_ERR_*. */
shb_status mhb_forced_response(const modal_model *model, const mhb_settings *settings,
                               const char *path, const shb_provenance *provenance,
                               shb_progress *progress, mhb_response **response);

#endif
