/* The tables of the report as HTML. */
#ifndef POSTPROC_REPORT_TABLES_H
#define POSTPROC_REPORT_TABLES_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"

void post_table_peaks(const post_analysis *analysis,
                      post_buffer         *out); /* peaks and folds, primary output */
/* Open, stuck and lowest peak of each resonance; nothing below two. */
void post_table_resonances(const post_analysis *analysis, post_buffer *out);
/* Points, iterations, seconds, largest error estimates, verdict, end of each branch. */
void post_table_quality(const post_analysis *analysis, post_buffer *out);
void post_table_modes(const mhb_response *response, post_buffer *out);
/* "key = value" lines. */
void post_table_settings(const char *settings, post_buffer *out);

#endif
