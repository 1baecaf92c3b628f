/* The curves of a response as plain SVG, for the stand-alone picture. */
#ifndef POSTPROC_REPORT_CHARTS_H
#define POSTPROC_REPORT_CHARTS_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/plot.h"

enum { POST_CLASS = 40 }; /* bytes of a group's style class */

/* Style class of a group's curves: "c0" (its rank), "varying", "limit open", "limit stuck". */
void post_group_class(const post_group *group, char out[POST_CLASS]);

/* True if the amplitudes vary so much that their axis is logarithmic. */
bool post_amplitude_is_log(const post_analysis *analysis);

/* All branches: amplitude of the primary output over the abscissa, into a data area whose place is
 * set. Ids begin with that of the area. */
void post_draw_response(const post_analysis *analysis, post_plot *plot);
/* What that chart shows, in words. */
void post_describe_response(const post_analysis *analysis, post_buffer *out);

/* Branch whose details are shown first: that of the lowest peak, else the first nonlinear one; -1
 * if there is none. */
int post_chosen_branch(const post_analysis *analysis);

#endif
