/* Findings of a response in sentences and four key figures: the head of the report. */
#ifndef POSTPROC_ANALYSIS_FINDINGS_H
#define POSTPROC_ANALYSIS_FINDINGS_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"

/* The key figures as HTML: open peak, stuck peak, lowest peak with its preload, reduction. */
void post_key_figures(const post_analysis *analysis, post_buffer *out);
/* The findings as an HTML list: optimum, frequency shift, folds, stability, range, incomplete
 * curves, accuracy. */
void post_findings(const post_analysis *analysis, post_buffer *out);

/* Number of modes without damping. Where nothing slips the height of their resonances is that of
 * the grid of frequencies. */
int post_undamped(const mhb_response *response);

/* The findings in one or two plain lines for the terminal, without a newline at the end. */
void post_summary(const post_analysis *analysis, post_buffer *out);

#endif
