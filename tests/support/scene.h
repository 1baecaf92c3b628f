/* A shipped scene run from end to end in a folder of its own: its curves, their peaks and folds. */
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

/* Copies source/case into folder and runs it there; the response NAME.response.h5 is read. Fails the test if it cannot. */
void scene_run(const char *folder, const char *source, const char *case_file, const char *name,
               mhb_response **response);

/* The curve of a kind and preload (N; the limits: any). Fails the test if there is none. */
const mhb_branch *scene_branch(const mhb_response *response, mhb_branch_kind kind, double n0);

/* Amplitude of a harmonic of the first probe as the report shows it: semi-major axis of its ellipse, m. */
double scene_amplitude(const mhb_response *response, const mhb_branch *b, int point, int k);

/* Highest maximum of the first probe's first harmonic within [from, to] Hz, refined between points. Fails the test if there
 * is none inside. */
scene_peak scene_highest(const mhb_response *response, const mhb_branch *b, double from, double to);

/* Folds but for pairs closer than 2e-5 (where slip begins a curve may turn back by a hair), at most most; how many. */
int scene_folds(const mhb_branch *b, int most, int *point);

/* Every point balances, no friction feeds the blade, every curve covers its range. */
void scene_is_sound(const mhb_response *response);

#endif
