/* Numbers of the page of a study, as one JSON document for its script: study.schema.json. */
#ifndef POSTPROC_STUDY_STUDY_DATA_H
#define POSTPROC_STUDY_STUDY_DATA_H

#include "postproc/draw/text_buffer.h"
#include "postproc/study/design_study.h"

/* Write the numbers. Curves are thinned: no point left out is farther from the chord than 0.1 % of
 * the chart. It is more where the curves would take over 1.5 MB.
 *
 *   tolerance  out  the share of the chart that was allowed
 *
 * Errors: SHB_ERR_IO no memory. */
shb_status study_data(const design_study *study, post_buffer *out, double *tolerance);

#endif
