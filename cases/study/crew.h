/* Workers of a study over MPI: rank 0 manages, the others compute. With one rank it computes
 * itself. Who waits sleeps: a core is not kept busy by waiting. */
#ifndef CASES_STUDY_CREW_H
#define CASES_STUDY_CREW_H

#include <stddef.h>

#include "cases/study/design_process.h"

/* The manager's side. */
typedef struct {
  void *context;
  /* The next design to compute and its request [n_request]; -1: none at present. */
  int (*next)(void *context, const double **value);
  /* A design is done. Errors end the study. */
  shb_status (*done)(void *context, int design, const char *bytes, size_t size);
  /* Called some hundred times a second at most; errors end the study. */
  shb_status (*tick)(void *context);
} crew_work;

/* Hand out designs until none is left and all are done, then release the workers. process starts
 * the child that computes; only the manager without workers uses it. */
shb_status crew_manage(const crew_work *work, design_process *process);

/* Compute designs until the manager releases the worker. */
shb_status crew_serve(design_process *process);

/* Release the workers without work, after an error of the manager. */
void crew_dismiss(void);

/* Number of processes that compute. */
int crew_workers(void);

#endif
