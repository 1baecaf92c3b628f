/* NAME.summary.json: what a script asks of a run, in one document. */
#ifndef POSTPROC_SUMMARY_SUMMARY_H
#define POSTPROC_SUMMARY_SUMMARY_H

#include "mesh/base/status.h"
#include "postproc/draw/text_buffer.h"
#include "postproc/field/blade_field.h"
#include "postproc/field/peak_stress.h"

typedef struct {
  const char             *name, *case_path; /* NULL: null */
  const char             *response, *modal; /* paths; NULL: that part is left out */
  const post_blade_field *field;            /* of the response; NULL or no nodes: no stress */
  const post_fatigue     *fatigue;          /* lines of all materials; NULL: no safety */
} post_summary_job;

/* Compose the document. Errors: of the files; SHB_ERR_IO no memory. */
shb_status post_summary_compose(const post_summary_job *job, post_buffer *out);

/* The same for a file alone: a modal or a response file, a study, a convergence study.
 * SHB_ERR_INPUT: another file. */
shb_status post_summary_of_file(const char *path, post_buffer *out);

#endif
