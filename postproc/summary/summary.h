/* NAME.summary.json: what a script asks of a run, in one document. */
#ifndef POSTPROC_SUMMARY_SUMMARY_H
#define POSTPROC_SUMMARY_SUMMARY_H

#include "mesh/base/status.h"
#include "postproc/draw/text_buffer.h"

typedef struct {
  const char *name, *case_path;    /* NULL: null */
  const char *response, *modal;    /* paths; NULL: that part is left out */
  double      endurance, ultimate; /* Pa, material.fatigue; 0: not given */
} post_summary_job;

/* Compose the document. Stress costs time where a mesh is large: without fatigue it is computed on
 * at most POST_STRESS_NUMBERS numbers of modal stress. Errors: of the files; SHB_ERR_IO no
 * memory. */
enum { POST_STRESS_NUMBERS = 30000000 };
shb_status post_summary_compose(const post_summary_job *job, post_buffer *out);

/* The same for a file alone: a modal or a response file, a study, a convergence study.
 * SHB_ERR_INPUT: another file. */
shb_status post_summary_of_file(const char *path, post_buffer *out);

#endif
