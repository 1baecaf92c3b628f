/* Random samples of a mistuned ring: the amplification factor of each, at every preload. */
#ifndef MHB_AMPLIFICATION_RING_SAMPLES_H
#define MHB_AMPLIFICATION_RING_SAMPLES_H

#include <stdbool.h>

#include "mesh/base/progress.h"
#include "mhb/amplification/ring_peak.h"
#include "modal/model/model.h"

/* Samples to be computed; both are called by one thread at a time. */
typedef struct {
  void *context;
  /* The next one: sample and preload. false: none is left. */
  bool (*next)(void *context, int *sample, int *preload);
  /* Its peak is known. Errors end the work. */
  shb_status (*done)(void *context, int sample, int preload, const mhb_ring_peak *peak);
  /* SHB_INTERRUPTED where the work is to end. */
  shb_status (*tick)(void *context);
} mhb_sample_work;

/* Who computes samples. */
typedef struct {
  void *context;
  shb_status (*share)(void *context, const mhb_sample_work *work);
  int sharing; /* processes that share the memory, each with a sample */
} mhb_sample_crew;

/* Which samples are drawn. */
typedef struct {
  int                    n;         /* 0: none */
  double                 deviation; /* standard deviation of the relative frequency deviations */
  long                   seed;
  const mhb_sample_crew *crew; /* NULL: the threads */
} mhb_sampling;

/* The peak of the worst blade on the main curve of a sample at a preload, traced from end to end.
 * Its worst is 0 where the curve has no point, and after an interrupt.
 *   blade    in  tuned
 *   preload  in  which of settings->n0
 * Errors: SHB_ERR_IO. */
shb_status mhb_ring_sample(const modal_model *blade, const mhb_settings *settings,
                           const mhb_sampling *sampling, int sample, int preload,
                           mhb_ring_peak *peak);

/* Fill response->samples, made here unless some of them are there. Threads take samples, or the
 * crew. The file is written every ten seconds,
 * and where interrupted.
 *   tuned  in  [preloads] peaks of the tuned ring
 * Errors: SHB_ERR_IO; SHB_INTERRUPTED. A curve that does not cover its range counts as far as it
 * goes. */
shb_status mhb_ring_samples(const modal_model *blade, const mhb_settings *settings,
                            const mhb_sampling *sampling, const mhb_ring_peak *tuned,
                            const char *path, const shb_provenance *provenance,
                            shb_progress *progress, mhb_response *response);

#endif
