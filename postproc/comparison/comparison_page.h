/* NAME.vs.OTHER.html: two runs on one page, curves over each other. One file, no network. */
#ifndef POSTPROC_COMPARISON_COMPARISON_PAGE_H
#define POSTPROC_COMPARISON_COMPARISON_PAGE_H

#include "postproc/comparison/run_comparison.h"
#include "postproc/draw/text_buffer.h"

void post_comparison_page(const post_comparison *comparison, post_buffer *out);

#endif
