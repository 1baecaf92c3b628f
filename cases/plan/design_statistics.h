/* From the designs of a study with uncertain keys to its statistics. */
#ifndef CASES_PLAN_DESIGN_STATISTICS_H
#define CASES_PLAN_DESIGN_STATISTICS_H

#include "mesh/base/status.h"
#include "postproc/study/design_study.h"

/* How the designs of a study were sampled. The designs of a group follow one another. */
typedef struct {
  int           n_varied; /* keys before the uncertain ones; 0: one group, without varied keys */
  int           group;    /* designs of a group */
  bool          blocks;   /* a group is Saltelli's plan of all keys; else each design is a sample */
  unsigned long seed;     /* of the bounds of the indices */
} design_samples;

/* Fill in the statistics of the study: `uncertainty` without varied keys, `robust` with them.
 * Percentiles are those of 5, 50 and 95 %, bounds have a confidence of 95 %. Designs that are not
 * done are failed samples. An output without a value, or without variance, has no statistic.
 *
 * Errors: SHB_ERR_IO no memory. */
shb_status design_statistics(const design_samples *samples, design_study *study);

#endif
