/* The charts of a response as plain SVG. The page's script draws the same charts anew. */
#ifndef POSTPROC_REPORT_CHARTS_H
#define POSTPROC_REPORT_CHARTS_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/plot.h"

enum { POST_CLASS = 40 }; /* bytes of a group's style class */

/* Style class of a group's curves: "c0" (its rank), "varying", "limit open", "limit stuck". */
void post_group_class(const post_group *group, char out[POST_CLASS]);

/* True if the amplitudes vary so much that their axis is logarithmic. */
bool post_amplitude_is_log(const post_analysis *analysis);

/* All branches: amplitude of the primary output over the abscissa. Ids begin with "response". */
void post_chart_response(const post_analysis *analysis, const char *case_name, post_buffer *out);
/* Axes and curves of that chart, into a data area whose place is set. */
void post_draw_response(const post_analysis *analysis, post_plot *plot);

/* Amplitude and abscissa of the highest peak over the preload; nothing below two preloads. */
void post_chart_tracking(const post_analysis *analysis, post_buffer *out);
/* Shares of the period and energy per cycle at the peak, a bar for each preload. */
void post_chart_state(const post_analysis *analysis, post_buffer *out);

/* Branch whose details are shown first: that of the lowest peak, else the first nonlinear one; -1
 * if there is none. */
int post_chosen_branch(const post_analysis *analysis);
/* Shares and energy along a branch; amplitude of each harmonic of the primary output along it. */
void post_chart_along(const post_analysis *analysis, int branch, post_buffer *out);
void post_chart_harmonics(const post_analysis *analysis, int branch, post_buffer *out);

#endif
