/* Workers over MPI, of a study or of samples of a ring: rank 0 manages, the others compute. With
 * one rank it computes itself. Who waits sleeps: a core is not kept busy by waiting. */
#ifndef CASES_STUDY_CREW_H
#define CASES_STUDY_CREW_H

#include <stddef.h>

#include "mesh/base/status.h"

/* The manager's side. */
typedef struct {
  void *context;
  /* The next job and its request [n_request]; -1: none at present. */
  int (*next)(void *context, const double **value);
  /* A job is done. Errors end the work. */
  shb_status (*done)(void *context, int job, const char *bytes, size_t size);
  /* Called some hundred times a second at most; errors end the work. */
  shb_status (*tick)(void *context);
} crew_work;

/* Who computes the jobs. */
typedef struct {
  void *context;
  int   n;
  /* Hand out jobs until none is left and all are done. */
  shb_status (*manage)(void *context, const crew_work *work);
} crew_staff;

/* What computes a job. */
typedef struct {
  void *context;
  int   n_request; /* values of a request */
  /* bytes: the answer, malloc'ed. Errors end the work. */
  shb_status (*compute)(void *context, const double *value, char **bytes, size_t *size);
} crew_computer;

/* Hand out jobs until none is left and all are done, then release the workers. The manager without
 * workers computes itself. */
shb_status crew_manage(const crew_work *work, const crew_computer *computer);

/* Compute jobs until the manager releases the worker. */
shb_status crew_serve(const crew_computer *computer);

/* Release the workers without work, after an error of the manager. */
void crew_dismiss(void);

/* Number of processes that compute. */
int crew_workers(void);

/* Those of them on this machine, at least 1. All ranks must call it. */
int crew_sharing(void);

#endif
