/* The charts of a response as SVG. The page's script redraws the same ones; without it these stand. */
#ifndef POSTPROC_REPORT_CHARTS_H
#define POSTPROC_REPORT_CHARTS_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/plot.h"

/* Whether the peaks of the groups differ so much that a logarithmic amplitude axis shows them better. */
bool post_amplitude_is_log(const post_analysis *analysis);

/* Amplitude of the primary output against the frequency or what is followed instead, all branches; ids begin with "response". */
void post_chart_response(const post_analysis *analysis, const char *case_name, post_buffer *out);
/* Its axes and curves alone, into a data area whose place is set. */
void post_draw_response(const post_analysis *analysis, post_plot *plot);

/* Peak amplitude and its place against preload; nothing if fewer than two preloads. */
void post_chart_tracking(const post_analysis *analysis, post_buffer *out);
/* Shares of the period and energy a cycle at the peak, a bar a preload; nothing if there is none. */
void post_chart_state(const post_analysis *analysis, post_buffer *out);

/* Branch whose details are shown first: the one with the lowest highest peak, else the first nonlinear; -1 if none. */
int post_chosen_branch(const post_analysis *analysis);
/* Shares and energy along one branch; amplitude of each harmonic along one branch (primary output). */
void post_chart_along(const post_analysis *analysis, int branch, post_buffer *out);
void post_chart_harmonics(const post_analysis *analysis, int branch, post_buffer *out);

#endif
