#include "mhb/amplification/ring_response.h"

#include "mhb/amplification/tuned_peaks.h"
#include "mhb/branches/forced_response.h"
#include "mhb/mistuning/mistuned_ring.h"

static void set(const mhb_response *response, mhb_branch *branch, const mhb_ring_peak *tuned) {
  const mhb_ring_peak own = mhb_ring_peak_of(response, branch);
  branch->amplification   = (mhb_amplification){.factor   = own.worst / tuned->worst,
                                                .worst    = own.worst,
                                                .worst_at = own.worst_at,
                                                .blade    = own.blade,
                                                .mean     = own.mean,
                                                .mean_at  = own.mean_at,
                                                .tuned    = tuned->worst,
                                                .tuned_at = tuned->worst_at};
}

shb_status mhb_ring_response(const mhb_settings *settings, const char *path,
                             const shb_provenance *provenance, shb_progress *progress,
                             mhb_response **out) {
  const mhb_mistuned_ring *ring     = settings->ring;
  const int                preloads = settings->parameter == MHB_IN_N0 ? 1 : settings->n_preloads;
  mhb_ring_peak            tuned[MHB_MAX_PRELOADS];
  shb_status found = mhb_forced_response(&ring->whole, settings, path, provenance, progress, out);
  if (!*out || (found != SHB_OK && found != SHB_NOT_CONVERGED)) return found;
  SHB_TRY(mhb_tuned_peaks(ring->tuned, settings, tuned));
  for (int i = 0; i < preloads && 2 + i < (*out)->n_branches; i++)
    if (tuned[i].worst > 0 && (*out)->branch[2 + i].n_points > 0)
      set(*out, &(*out)->branch[2 + i], &tuned[i]);
  if (path) SHB_TRY(mhb_response_write(*out, path, provenance));
  return found;
}
