/* Memory that points by time integration take, foreseen from sizes; how many points fit at a time.
 *
 * Counted are the arrays of one integrator, the receptances it starts with, and the points found.
 * docs/user/limits.md compares it with measured runs. */
#ifndef MHB_INTEGRATION_INTEGRATION_MEMORY_H
#define MHB_INTEGRATION_INTEGRATION_MEMORY_H

#include <stdbool.h>

#include "mhb/problem/settings.h"
#include "modal/model/model.h"

typedef struct {
  int  pairs;     /* contact points of a blade */
  int  blades;    /* integrated; 1: on the ground */
  bool dense;     /* they are one structure: different blades, or a disc */
  bool both;      /* contacts on both sides of a blade */
  bool residual;  /* residual terms of the contacts, held for each harmonic */
  bool inertia;   /* residual inertia becomes modes */
  bool coriolis;  /* the modes of a blade are coupled */
  int  modes;     /* of a blade */
  int  probes;    /* of a blade */
  int  harmonics; /* of a point, and of its start */
  int  points;    /* in all */
  int  threads;   /* that could be used, at least 1 */
} mhb_integration_size;

/* Of a model, whose blades are equal or joined to one structure already.
 *   harmonics  in  of a point
 *   points     in  in all */
mhb_integration_size mhb_integration_size_of(const modal_model *model, const mhb_settings *settings,
                                             int harmonics, int points);

/* Bytes with one thread. */
double mhb_integration_bytes(const mhb_integration_size *size);

/* Threads that memory allows, size->threads at most.
 * SHB_ERR_INPUT: the memory left is too little for one. The message has the bytes needed and left,
 * and the most contact points, blades, harmonics and points that fit. */
shb_status mhb_integration_threads(const mhb_integration_size *size, int *threads);

#endif
