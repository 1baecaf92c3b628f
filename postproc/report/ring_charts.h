/* Charts of a ring of single blades: the amplitude of every blade, and the distribution of the
 * amplification factor over random rings. */
#ifndef POSTPROC_REPORT_RING_CHARTS_H
#define POSTPROC_REPORT_RING_CHARTS_H

#include "mhb/response/response.h"
#include "postproc/draw/text_buffer.h"

/* The amplitude of every blade, relative to the highest. Main curves: at the highest point,
 * others where the fewest blades take part, at most a dozen. Nothing for a wave. */
void post_put_blades(const mhb_response *response, post_buffer *out);

/* Corners of the share of rings whose factor is at most x. It rises by 1/n at each of the n factors
 * of a preload that are done and not marked.
 *   x, share  out  [2 samples->n]
 * Returns the number of corners, 2 n; 0 without factors. */
int post_factor_corners(const mhb_samples *samples, int preload, double *x, double *share);

/* A curve for each preload, in the colour of its rank. Nothing where no preload has two factors. */
void post_put_factors(const mhb_samples *samples, post_buffer *out);

#endif
