/* The processes that compute designs: a crash in one costs the design at work, and nothing else. */
#ifndef CASES_STUDY_DESIGN_PROCESS_H
#define CASES_STUDY_DESIGN_PROCESS_H

#include <stddef.h>
#include <sys/types.h>

#include "cases/designs/study_spec.h"
#include "cases/study/crew.h"
#include "mesh/base/status.h"

/* What such a process is told at its start. */
typedef struct {
  const char *study;     /* path of the study file */
  const char *texts;     /* those of the study, in the order of study_texts, each with its NUL */
  size_t      size;      /* of the texts */
  int         n_request; /* values of a request: see below */
  int         n_outputs, n_derivatives;
  int         sharing; /* processes on this machine that compute designs */
} design_job;

/* A request: the values of a design, then those of a solved one from whose peak it is tried again,
 * or NAN. 2 n_keys values. */

typedef struct {
  const design_job *job;
  pid_t             child; /* 0: not running */
  int               to, from;
} design_process;

/* Compute one design in a child process, the command design, started if it is not running. If it
 * dies, the message holds a failed design with the signal as its reason.
 *
 *   value  in   [n_request]
 *   bytes  out  design_message; malloc'ed
 * Errors: SHB_ERR_IO it cannot be started, or no memory. */
shb_status design_process_run(design_process *process, const double *value, char **bytes,
                              size_t *size);

/* End the child process. */
void design_process_stop(design_process *process);

/* Several of them on this machine, which the manager feeds. */
typedef struct {
  int             n;
  design_process *process; /* [n] */
  int            *design;  /* [n] at work, or -1 */
} design_pool;

/* Errors: SHB_ERR_IO no memory. Free it in any case; its processes end. */
shb_status design_pool_create(const design_job *job, int n, design_pool *pool);
void       design_pool_free(design_pool *pool);

/* Hand out designs until none is left and all are done (crew.h). pool: a design_pool. After SIGINT,
 * SIGTERM or SIGHUP the processes are told to stop, and what they had begun is not done. */
shb_status design_pool_manage(void *pool, const crew_work *work);

/* The child's side: the texts of the study from standard input; malloc'ed, the members point into
 * *texts. Errors: SHB_ERR_IO. */
shb_status design_process_texts(char **texts, study_texts *out);

/* Serve requests until the pipe is closed. The answer of compute is a packed design. Returns the
 * status of the pipe. */
typedef shb_status design_compute(void *context, const double *value, char **bytes, size_t *size);
shb_status         design_process_serve(int n_request, design_compute *compute, void *context);

#endif
