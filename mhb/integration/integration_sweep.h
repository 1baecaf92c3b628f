/* Points by time integration over the frequency range, to go beside the curves of the balance.
 *
 *   balance  each point starts on a stable solution of the balance, as far as its harmonics tell: where there are several, several points
 *   rest     each point starts at rest
 *   state    one frequency after the other, up, down, or both, from the state the last one left
 * A point runs until the motion repeats itself, or for max_periods; then again with twice the steps, until two runs agree within the
 * tolerance. Not to repeat is an answer, with its spectrum. */
#ifndef MHB_INTEGRATION_INTEGRATION_SWEEP_H
#define MHB_INTEGRATION_INTEGRATION_SWEEP_H

#include "mesh/base/progress.h"
#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"

/* One branch (kind integration) for each preload and direction, points by ascending frequency (falling for down).
 *   balance     in   its response file, for start balance; else NULL
 *   path        in   published every 10 s, at the end and when interrupted; NULL: not at all
 *   provenance  in   for path
 *   response    out  the caller's
 * In a run-up the structure at each point is that at its speed, and stays so while it is integrated.
 * Errors: SHB_ERR_INPUT state in a run-up; no solution of the balance at a preload, load harmonics beyond those kept; SHB_ERR_IO; SHB_NOT_CONVERGED the forces
 * of a step were not found at some point, which is left out; SHB_INTERRUPTED. */
shb_status mhb_integration_sweep(const modal_model *model, const mhb_settings *settings,
                                 const mhb_integration_settings *witness,
                                 const mhb_response *balance, const char *path,
                                 const shb_provenance *provenance, shb_progress *progress,
                                 mhb_response **response);

#endif
