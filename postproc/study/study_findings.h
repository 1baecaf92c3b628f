/* What a study says, in words: key figures and findings at the top of its page, as HTML. */
#ifndef POSTPROC_STUDY_STUDY_FINDINGS_H
#define POSTPROC_STUDY_STUDY_FINDINGS_H

#include "postproc/draw/text_buffer.h"
#include "postproc/study/design_study.h"

/* The sentence that answers the study, escaped for HTML. It names the design with the lowest
 * objective, or mean and highest percentile of uncertain keys. */
void study_headline(const design_study *study, post_buffer *out);

/* <dl> of the largest figures. Nothing if no design is done. */
void study_key_figures(const design_study *study, post_buffer *out);

/* <ul> of what follows from the designs: what matters most, bounds that were met, designs that
 * cannot be told apart. Designs that failed stand there with their reasons. */
void study_findings(const design_study *study, post_buffer *out);

/* One line for a terminal. */
void study_summary(const design_study *study, post_buffer *out);

#endif
