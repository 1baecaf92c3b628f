/* Numbers of a ring of different blades for the page: the amplitude of every blade, and the
 * amplification factors of random rings. */
#ifndef POSTPROC_REPORT_RING_DATA_H
#define POSTPROC_REPORT_RING_DATA_H

#include "mhb/response/response.h"
#include "postproc/draw/text_buffer.h"

/* ,"ring":{"panels":[{n0, value, branch, kind, stable, amplitude [blade]}]}: main curves at their
 * highest point, others where the fewest blades take part. Nothing without a ring that moves.
 * Returns the number of panels. */
int post_put_blades(const mhb_response *response, post_buffer *out);

/* ,"factors":[{n0, factor [sample]}]: those that are results. Nothing below two of a preload.
 * Returns true if there are any. samples: may be NULL. */
bool post_put_factors(const mhb_samples *samples, post_buffer *out);

#endif
