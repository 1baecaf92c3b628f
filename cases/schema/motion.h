/* The file of `shroudhb contact`: a contact block as in a case file, and a prescribed motion. */
#ifndef CASES_SCHEMA_MOTION_H
#define CASES_SCHEMA_MOTION_H

#include <complex.h>
#include <stdio.h>

#include "cases/parse/keys.h"
#include "cases/parse/reader.h"
#include "cases/schema/overrides.h"
#include "mesh/base/status.h"
#include "mhb/problem/settings.h"

enum { CASE_MAX_MOTION = 200 }; /* harmonics */

typedef struct {
  /* mu, ku, kv, preload and the one n0; the other settings are unused */
  mhb_settings    contact;
  int             n_harmonics; /* the longest of the three signals, at least 1 */
  double complex *motion; /* [3 (v, u, w)][n_harmonics + 1] m; x(t) = Re sum_k A_k exp(j k w t) */
} case_motion;

/* The keys of a motion file: those of contact, and the three signals. */
case_keys case_motion_keys(case_key row[CASE_MAX_KEYS]);

/* They as text, for `shroudhb keys motion`. */
void case_print_motion_keys(FILE *out);

/* Read and check a motion file. Errors as in case_read.
 *   overrides  in  or NULL; only their texts count */
shb_status case_motion_read(const char *path, const case_overrides *overrides, FILE *errors,
                            case_motion *out);
void       case_motion_free(case_motion *motion);

#endif
