/* What all pages share: style sheet, scripts and the head. Style sheet and scripts are built into
 * the program from page.css, plot.js and page.js. */
#ifndef POSTPROC_REPORT_PAGE_H
#define POSTPROC_REPORT_PAGE_H

#include "postproc/draw/text_buffer.h"

extern const char post_page_css[];
extern const char post_plot_js[];  /* numbers, axes and panels; comes before a page's own script */
extern const char post_blade_js[]; /* the blade in motion */
extern const char post_page_js[];  /* the report of a case */

/* Start a page: its head as far as the open style element, with post_page_css in it. The title is
 * "NAME · subject". The content security policy forbids every load from elsewhere. */
void post_page_open(const char *name, const char *subject, post_buffer *out);

#endif
