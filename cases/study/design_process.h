/* The process that computes designs: a crash in it costs the design at work, and nothing else. */
#ifndef CASES_STUDY_DESIGN_PROCESS_H
#define CASES_STUDY_DESIGN_PROCESS_H

#include <stddef.h>
#include <sys/types.h>

#include "mesh/base/status.h"

typedef struct {
  const char *study;     /* path of the study file */
  int         n_request; /* values of a request: see below */
  int         n_outputs, n_derivatives;
  int         sharing; /* processes on this machine that compute designs */
  pid_t       child;   /* 0: not running */
  int         to, from;
} design_process;

/* A request: the values of a design, then those of a solved one from whose peak it is tried again,
 * or NAN. 2 n_keys values. */

/* Compute one design in the child process shroudhb-design, which is started if it is not running.
 * If it dies, the message holds a failed design with the signal as its reason.
 *
 *   value  in   [n_request]
 *   bytes  out  design_message; malloc'ed
 * Errors: SHB_ERR_IO it cannot be started, or no memory. */
shb_status design_process_run(design_process *process, const double *value, char **bytes,
                              size_t *size);

/* End the child process. */
void design_process_stop(design_process *process);

/* The child's side: serve requests until the pipe is closed. The answer of compute is a packed
 * design. Returns the status of the pipe. */
typedef shb_status design_compute(void *context, const double *value, char **bytes, size_t *size);
shb_status         design_process_serve(int n_request, design_compute *compute, void *context);

#endif
