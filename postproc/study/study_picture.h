/* NAME.study.svg: the chief chart of a study.
 *
 * Uncertain keys: share of the samples below a value, with the percentiles and their intervals;
 * beside varied keys: the percentiles over one of these. An
 * optimisation: each evaluation and the best so far. Else: the objective over the key that matters
 * most, coloured by a second key. */
#ifndef POSTPROC_STUDY_STUDY_PICTURE_H
#define POSTPROC_STUDY_STUDY_PICTURE_H

#include "postproc/draw/text_buffer.h"
#include "postproc/study/design_study.h"

/* Put the picture. Errors: SHB_ERR_IO no memory; SHB_ERR_INPUT no design gave a result: there is no
 * picture. */
shb_status study_picture(const design_study *study, post_buffer *out);

#endif
