/* Peaks over the preload, one resonance at a time.
 *
 * Where several resonances lie in the range, the highest peak may belong to another one at each
 * preload. So the peaks of the curves are joined: from the open limit over the rising preloads to
 * the stuck limit. Between two steps the peaks keep their order of frequency. Of all ways to join
 * them the cheapest is taken. A pair costs the ratio of its frequencies, |ln|. A peak without a
 * partner costs half its height over the highest of its curve. A chain from the open limit and one
 * to the stuck limit that lie side by side are the two halves of one resonance. */
#ifndef POSTPROC_ANALYSIS_RESONANCES_H
#define POSTPROC_ANALYSIS_RESONANCES_H

#include "postproc/analysis/response_analysis.h"

/* The resonances of an output from its values on every branch; none over another parameter than the
 * frequency, or without a preload. Errors: SHB_ERR_IO no memory. */
shb_status post_resonances_find(const post_analysis *analysis, double *const *values,
                                post_resonances *resonances);
/* Those of the primary output, kept in the analysis. Errors: the same. */
shb_status post_resonances_add(post_analysis *analysis);

/* Index of the resonance that holds a point of a branch as a peak; -1: none. */
int post_resonance_of(const post_resonances *resonances, int branch, int point);

#endif
