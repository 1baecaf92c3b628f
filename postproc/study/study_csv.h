/* NAME.study.csv: a design study as a table for other programs. */
#ifndef POSTPROC_STUDY_STUDY_CSV_H
#define POSTPROC_STUDY_STUDY_CSV_H

#include "postproc/draw/text_buffer.h"
#include "postproc/study/design_study.h"

/* CSV (RFC 4180), a row a design. Columns: design (from 1), the varied keys in SI, the outputs,
 * OUTPUT_error for every output that has one, the derivatives "d peak/d PARAMETER", status, reason.
 * Unknown numbers are empty. */
void study_csv(const design_study *study, post_buffer *out);

#endif
