/* NAME.study.html: a design study as one page that loads nothing from elsewhere.
 *
 * The head, the findings and the text of the study stand in the page itself. Charts and table are
 * drawn by a script from the numbers of study_data; charts without data are left out. */
#ifndef POSTPROC_STUDY_STUDY_PAGE_H
#define POSTPROC_STUDY_STUDY_PAGE_H

#include "postproc/draw/text_buffer.h"
#include "postproc/study/design_study.h"

extern const char post_study_css[], post_study_html[], post_study_js[]; /* as in report/page.h */

/* Put the page. Errors: SHB_ERR_IO no memory. */
shb_status study_page(const design_study *study, post_buffer *out);

#endif
