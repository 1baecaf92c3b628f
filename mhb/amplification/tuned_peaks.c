#include "mhb/amplification/tuned_peaks.h"

#include <string.h>

#include "mhb/branches/forced_response.h"

shb_status mhb_tuned_peaks(const modal_model *tuned, const mhb_settings *asked,
                           mhb_ring_peak *peak) {
  mhb_settings  settings = *asked;
  shb_progress  progress = shb_progress_start("mhb", true, false);
  mhb_response *response = NULL;
  settings.ring          = NULL;
  settings.stability     = MHB_STABILITY_NEVER;
  settings.lasting       = MHB_LASTING_NEVER;
  settings.search.starts = 0;
  settings.flips         = false;
  settings.resume        = false;
  const int  preloads    = settings.parameter == MHB_IN_N0 ? 1 : settings.n_preloads;
  shb_status status      = mhb_forced_response(tuned, &settings, NULL, NULL, &progress, &response);
  memset(peak, 0, sizeof *peak * (size_t)preloads);
  for (int i = 0; response && i < preloads && 2 + i < response->n_branches; i++)
    peak[i] = mhb_ring_peak_of(response, &response->branch[2 + i]);
  mhb_response_destroy(response);
  return status == SHB_NOT_CONVERGED ? SHB_OK : status;
}
