#include "mhb/amplification/ring_response.h"

#include <stdlib.h>
#include <string.h>

#include "mhb/amplification/tuned_peaks.h"
#include "mhb/branches/forced_response.h"
#include "mhb/mistuning/mistuned_ring.h"

static void set(const mhb_response *response, mhb_branch *branch, const mhb_ring_peak *tuned) {
  const mhb_ring_peak own = mhb_ring_peak_of(response, branch);
  if (own.marked || tuned->marked) return;
  branch->amplification = (mhb_amplification){.factor   = own.worst / tuned->worst,
                                              .worst    = own.worst,
                                              .worst_at = own.worst_at,
                                              .blade    = own.blade,
                                              .mean     = own.mean,
                                              .mean_at  = own.mean_at,
                                              .tuned    = tuned->worst,
                                              .tuned_at = tuned->worst_at};
}

/* Samples of the file at path, if its settings are those of this run. */
static mhb_samples *earlier_samples(const mhb_settings *settings, const char *path,
                                    const shb_provenance *provenance) {
  mhb_response *old     = NULL;
  mhb_samples  *samples = NULL;
  char         *text    = NULL;
  hid_t         file;
  if (!settings->resume || !path || h5_check_earlier(path) != SHB_OK ||
      h5_open(path, &file) != SHB_OK)
    return NULL;
  bool same = h5_read_attribute_text(file, "/", "settings", &text) == SHB_OK && text &&
              strcmp(text, provenance->settings) == 0;
  h5_close(file);
  free(text);
  if (!same || mhb_response_read(path, &old) != SHB_OK) return NULL;
  samples      = old->samples;
  old->samples = NULL;
  mhb_response_destroy(old);
  return samples;
}

static shb_status add_peaks(const mhb_settings *settings, const mhb_sampling *sampling,
                            const char *path, const shb_provenance *provenance,
                            shb_progress *progress, mhb_response *response) {
  const mhb_mistuned_ring *ring     = settings->ring;
  const int                preloads = settings->parameter == MHB_IN_N0 ? 1 : settings->n_preloads;
  mhb_ring_peak            tuned[MHB_MAX_PRELOADS];
  shb_status               status = SHB_OK;
  SHB_TRY(mhb_tuned_peaks(ring->tuned, settings, tuned));
  for (int i = 0; i < preloads && 2 + i < response->n_branches; i++)
    if (tuned[i].worst > 0 && response->branch[2 + i].n_points > 0)
      set(response, &response->branch[2 + i], &tuned[i]);
  if (sampling && sampling->n > 0)
    status = mhb_ring_samples(ring->tuned, settings, sampling, tuned, path, provenance, progress,
                              response);
  response->unfinished = status != SHB_OK;
  if (path) SHB_TRY(mhb_response_write(response, path, provenance));
  return status;
}

shb_status mhb_ring_response(const mhb_settings *settings, const mhb_sampling *sampling,
                             const char *path, const shb_provenance *provenance,
                             shb_progress *progress, mhb_response **out) {
  mhb_samples *samples =
      sampling && sampling->n > 0 ? earlier_samples(settings, path, provenance) : NULL;
  const shb_status found =
      mhb_forced_response(&settings->ring->whole, settings, path, provenance, progress, out);
  if (!*out) {
    mhb_samples_destroy(samples);
    return found;
  }
  (*out)->samples = samples;
  if (samples && path) SHB_TRY(mhb_response_write(*out, path, provenance)); /* the sweep has none */
  if (found != SHB_OK && found != SHB_NOT_CONVERGED) return found;
  SHB_TRY(add_peaks(settings, sampling, path, provenance, progress, *out));
  return found;
}
