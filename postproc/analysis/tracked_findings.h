/* What a response with tracked peaks says: the optimum, and how far it can be trusted. */
#ifndef POSTPROC_ANALYSIS_TRACKED_FINDINGS_H
#define POSTPROC_ANALYSIS_TRACKED_FINDINGS_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"

/* There is an optimum, and the errors of the points next to it are within the tolerance. */
bool post_optimum_told(const mhb_response *response);
/* The key figure as HTML; nothing without an optimum. */
void post_tracked_figure(const post_analysis *analysis, post_buffer *out);
/* Items of the list of findings: optimum with its bracket, kink, check by a sweep, what was not
 * looked at. */
void post_tracked_findings(const post_analysis *analysis, post_buffer *out);
/* "optimum n0 = 11.842285 N: 35.1 µm at 213.49 Hz" for the terminal. */
void post_tracked_summary(const post_analysis *analysis, post_buffer *out);

#endif
