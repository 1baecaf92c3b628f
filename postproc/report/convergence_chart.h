/* Work-precision plot of a convergence study: error over seconds, one line for each ladder. */
#ifndef POSTPROC_REPORT_CONVERGENCE_CHART_H
#define POSTPROC_REPORT_CONVERGENCE_CHART_H

#include "postproc/analysis/convergence.h"

/* A stand-alone picture, light or dark as the viewer prefers. It says so if no rung was
 * compared. */
void post_convergence_picture(const post_convergence *study, const char *case_name,
                              post_buffer *out);

/* The section of the report: plot, conclusion, table. The page brings the style. */
void post_convergence_section(const post_convergence *study, post_buffer *out);

/* Style rules that the page needs for the lines. */
extern const char post_convergence_css[];

#endif
