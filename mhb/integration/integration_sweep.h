/* Points by time integration over the frequency range, comparable with the curves of the balance.
 *
 *   balance  a point starts on each solution of the balance that is not unstable, by its harmonics
 *   rest     each point starts at rest
 *   state    frequencies in order, up, down or both; a point starts from the last one's end state
 *
 * A point is integrated until the motion repeats itself, or for max_periods; then again with twice
 * the steps until two runs agree within the tolerance. A motion that does not repeat is a result,
 * with its spectrum. */
#ifndef MHB_INTEGRATION_INTEGRATION_SWEEP_H
#define MHB_INTEGRATION_INTEGRATION_SWEEP_H

#include "mesh/base/progress.h"
#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"

/* Harmonics of a point: those asked for, or of the balance (NULL: none). */
int mhb_integration_harmonics(const modal_model *model, const mhb_settings *settings,
                              const mhb_integration_settings *integration,
                              const mhb_response             *balance);

/* One branch (kind integration) for each preload and direction; points by ascending frequency,
 * descending for down.
 *   balance     in   its response, for start balance; else NULL
 *   path        in   response file: written every 10 s, at the end and if interrupted; NULL: none
 *   provenance  in   for path
 *   response    out  the caller's
 * In a run-up the structure of a point is that at its speed, constant while it is integrated.
 * Errors: SHB_ERR_IO, SHB_INTERRUPTED, and
 *   SHB_ERR_INPUT      start state in a run-up; no solution of the balance at a preload; fewer
 *                      harmonics than the load has
 *   SHB_NOT_CONVERGED  the forces of a step were not found at some point, which is left out */
shb_status mhb_integration_sweep(const modal_model *model, const mhb_settings *settings,
                                 const mhb_integration_settings *integration,
                                 const mhb_response *balance, const char *path,
                                 const shb_provenance *provenance, shb_progress *progress,
                                 mhb_response **response);

#endif
