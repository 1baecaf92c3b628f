/* The file of `shroudhb contact`: a contact block as in a case file, and a prescribed motion. */
#ifndef CASES_SCHEMA_MOTION_H
#define CASES_SCHEMA_MOTION_H

#include <complex.h>
#include <stdio.h>

#include "mesh/base/status.h"
#include "mhb/problem/settings.h"

enum { CASE_MAX_MOTION = 200 }; /* harmonics */

typedef struct {
  /* mu, ku, kv, preload and the one n0; the other settings are unused */
  mhb_settings    contact;
  int             n_harmonics; /* the longest of the three signals, at least 1 */
  double complex *motion; /* [3 (v, u, w)][n_harmonics + 1] m; x(t) = Re sum_k A_k exp(j k w t) */
} case_motion;

/* Read and check a motion file. Errors as in case_read. */
shb_status case_motion_read(const char *path, FILE *errors, case_motion *out);
void       case_motion_free(case_motion *motion);

#endif
