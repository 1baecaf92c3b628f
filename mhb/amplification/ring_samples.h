/* Random samples of a mistuned ring: the amplification factor of each, at every preload. */
#ifndef MHB_AMPLIFICATION_RING_SAMPLES_H
#define MHB_AMPLIFICATION_RING_SAMPLES_H

#include "mesh/base/progress.h"
#include "mhb/amplification/ring_peak.h"
#include "modal/model/model.h"

/* Which samples are drawn. */
typedef struct {
  int    n;         /* 0: none */
  double deviation; /* standard deviation of the relative frequency deviations */
  long   seed;
} mhb_sampling;

/* Fill response->samples, made here unless some of them are there. Threads take samples. The main
 * curve of a sample and preload is traced from end to end. The file is written every ten seconds,
 * and where interrupted.
 *   tuned  in  [preloads] peaks of the tuned ring
 * Errors: SHB_ERR_IO; SHB_INTERRUPTED. A curve that does not cover its range counts as far as it
 * goes. */
shb_status mhb_ring_samples(const modal_model *blade, const mhb_settings *settings,
                            const mhb_sampling *sampling, const mhb_ring_peak *tuned,
                            const char *path, const shb_provenance *provenance,
                            shb_progress *progress, mhb_response *response);

#endif
