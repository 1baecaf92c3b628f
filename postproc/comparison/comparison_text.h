/* Two runs as lines for a terminal, and as JSON (docs/user/summary.md). */
#ifndef POSTPROC_COMPARISON_COMPARISON_TEXT_H
#define POSTPROC_COMPARISON_COMPARISON_TEXT_H

#include "postproc/comparison/run_comparison.h"
#include "postproc/draw/text_buffer.h"

void post_comparison_text(const post_comparison *comparison, post_buffer *out);
void post_comparison_json(const post_comparison *comparison, post_buffer *out);

#endif
