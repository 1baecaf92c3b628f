/* The sentence on a ring of different blades: which swings highest, and by how much more than with
 * equal blades. */
#ifndef POSTPROC_ANALYSIS_RING_FINDINGS_H
#define POSTPROC_ANALYSIS_RING_FINDINGS_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"

/* List items of HTML; nothing for a wave. */
void post_put_ring(const post_analysis *analysis, post_buffer *out);

#endif
