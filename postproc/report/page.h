/* What all pages share: style sheet and head. Style sheet, template and script are built into the
 * program (postproc/script/embed.cmake). */
#ifndef POSTPROC_REPORT_PAGE_H
#define POSTPROC_REPORT_PAGE_H

#include "postproc/draw/text_buffer.h"

extern const char post_page_css[];
extern const char post_report_html[]; /* template of the report of a case (draw/template.h) */
extern const char post_report_js[];

/* Start a page: its head as far as the open style element, with post_page_css in it. The title is
 * "NAME · subject". The content security policy forbids every load from elsewhere. */
void post_page_open(const char *name, const char *subject, post_buffer *out);

#endif
