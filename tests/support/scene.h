/* An example case run from mesh to curves in a folder of its own: its curves, peaks and folds. */
#ifndef TESTS_SUPPORT_SCENE_H
#define TESTS_SUPPORT_SCENE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

#include "mhb/response/response.h"
#include "tests/support/check.h"
#include "tests/support/scratch.h"

typedef struct {
  double frequency, amplitude; /* Hz, m */
  int    point;
} scene_peak;

/* Copy source/case into folder, run it there and read NAME.response.h5. Fails the test if it
 * cannot. */
void scene_run(const char *folder, const char *source, const char *case_file, const char *name,
               mhb_response **response);

/* Copy source/study.yaml, and the case of the example beside it, into folder/name. Run the study
 * there. Returns 0 if it succeeds. */
int scene_run_study(const char *folder, const char *source, const char *name);

/* Remove a folder with all that is in it. Returns 0 if it succeeds. */
int scene_remove(const char *folder);

/* The curve of a kind and preload (N; any for the limits). Fails the test if there is none. */
const mhb_branch *scene_branch(const mhb_response *response, mhb_branch_kind kind, double n0);

/* Amplitude of a harmonic of the first probe as in the report: semi-major axis of its ellipse,
 * m. */
double scene_amplitude(const mhb_response *response, const mhb_branch *b, int point, int k);

/* Highest maximum of the first probe's first harmonic within [from, to] Hz, refined between points.
 * Fails the test if there is none inside. */
scene_peak scene_highest(const mhb_response *response, const mhb_branch *b, double from, double to);

/* Folds, at most `most`; returns their number. Pairs closer than 2e-5 do not count: at the onset of
 * slip a curve may turn back over a tiny distance. */
int scene_folds(const mhb_branch *b, int most, int *point);

/* Check that every point solves the balance, that friction never adds energy, and that every curve
 * covers its range. */
void scene_is_sound(const mhb_response *response);

#endif
