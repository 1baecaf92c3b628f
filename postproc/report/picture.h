/* NAME.svg: the forced response as a stand-alone picture for documents and web pages. */
#ifndef POSTPROC_REPORT_PICTURE_H
#define POSTPROC_REPORT_PICTURE_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"

/* The picture holds its own white background, title, legend and style. */
void post_picture(const post_analysis *analysis, const char *case_name, post_buffer *out);

#endif
