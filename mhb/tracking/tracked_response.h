/* The response of a case with mhb.track: all peaks of an output, or all folds, flips or
 * Neimark-Sacker points, along a parameter.
 *
 * Frequency sweeps at a few values of the parameter give points to start from. Each that is
 * not on a known curve is followed both ways. Where a high branch ends inside the range, a further
 * sweep finds the peak that takes over. A sweep at the optimum verifies it. */
#ifndef MHB_TRACKING_TRACKED_RESPONSE_H
#define MHB_TRACKING_TRACKED_RESPONSE_H

#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"

/* The output that the settings name, as in output_amplitude.h. SHB_ERR_INPUT: the model has no such
 * probe; the message lists those it has. */
shb_status mhb_output_named(const modal_model *model, const char *name, int *output);

/* Settings of a frequency sweep at a value of the parameter that a tracked run follows. */
mhb_settings mhb_tracked_settings(const mhb_settings *settings, double value);

/* Follow, and publish to path unless it is NULL. Branches are of kind tracked, in the order in
 * which they were found.
 *   response  out  the caller destroys it (NULL on error)
 * Returns SHB_OK, SHB_NOT_CONVERGED if the highest peak of a sweep, or a flip or
 * Neimark-Sacker point, led to no curve, SHB_INTERRUPTED, or SHB_ERR_*. */
shb_status mhb_tracked_response(const modal_model *model, const mhb_settings *settings,
                                const char *path, const shb_provenance *provenance,
                                shb_progress *progress, mhb_response **response);

#endif
