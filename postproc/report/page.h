/* Style sheet and script of the page, page.css and page.js, built into the program. */
#ifndef POSTPROC_REPORT_PAGE_H
#define POSTPROC_REPORT_PAGE_H

extern const char post_page_css[], post_page_js[];

#endif
