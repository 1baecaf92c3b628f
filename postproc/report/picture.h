/* NAME.svg: the forced response as a picture of its own, for documents and web pages. */
#ifndef POSTPROC_REPORT_PICTURE_H
#define POSTPROC_REPORT_PICTURE_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"

/* White background, title, legend and style inside; needs nothing else. */
void post_picture(const post_analysis *analysis, const char *case_name, post_buffer *out);

#endif
