/* The work-precision plot of a convergence study: error against seconds, a line a ladder. */
#ifndef POSTPROC_REPORT_CONVERGENCE_CHART_H
#define POSTPROC_REPORT_CONVERGENCE_CHART_H

#include "postproc/analysis/convergence.h"

/* A picture of its own, light or dark as the viewer wants; needs nothing else. Without a rung that was compared it says so. */
void post_convergence_picture(const post_convergence *study, const char *case_name,
                              post_buffer *out);

/* The report's section: plot, conclusion, table. The page brings the style. */
void post_convergence_section(const post_convergence *study, post_buffer *out);

/* What the page's style must know of the plot's lines. */
extern const char post_convergence_css[];

#endif
