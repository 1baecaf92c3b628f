/* The distribution of the amplification factor over random rings: section and chart. */
#ifndef POSTPROC_REPORT_FACTOR_CHART_H
#define POSTPROC_REPORT_FACTOR_CHART_H

#include "mhb/response/response_samples.h"
#include "postproc/draw/text_buffer.h"

/* Corners of the share of rings whose factor is at most x. It rises by 1/n at each of the n factors
 * of a preload that are done.
 *   x, share  out  [2 samples->n]
 * Returns the number of corners, 2 n; 0 without factors. */
int post_factor_corners(const mhb_samples *samples, int preload, double *x, double *share);

/* A curve for each preload, in the colour of its rank. Nothing where no preload has two factors. */
void post_put_factors(const mhb_samples *samples, post_buffer *out);

#endif
