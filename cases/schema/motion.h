/* The file of "shroudhb contact": a contact block as in a case, and the motion it undergoes. */
#ifndef CASES_SCHEMA_MOTION_H
#define CASES_SCHEMA_MOTION_H

#include <complex.h>
#include <stdio.h>

#include "mesh/base/status.h"
#include "mhb/problem/settings.h"

enum { CASE_MAX_MOTION = 200 }; /* harmonics */

typedef struct {
  mhb_settings    contact;     /* mu, ku, kv, preload and the one n0; the rest is of no meaning */
  int             n_harmonics; /* the longest of the three signals, at least 1 */
  double complex *motion; /* [3 (v, u, w)][n_harmonics + 1] m; x(t) = Re sum_k A_k exp(j k w t) */
} case_motion;

/* Read and check such a file; errors as in case_read. */
shb_status case_motion_read(const char *path, FILE *errors, case_motion *out);
void       case_motion_free(case_motion *motion);

#endif
