/* Motions for tests of the contact law: every kind of state, transition and near miss.
 *
 * The first ten are those of the benchmark's table. Amplitudes are about 1e-4 m at 1e6 N/m and 100
 * N. */
#ifndef TESTS_SUPPORT_MOTION_SUITE_H
#define TESTS_SUPPORT_MOTION_SUITE_H

#include "mhb/contact/contact.h"

enum { SUITE_HARMONICS = 7, SUITE_WIDTH = 2 * SUITE_HARMONICS + 1, SUITE_FIRST = 10 };

typedef struct {
  const char *name;
  mhb_law     law;
  double      motion[3][SUITE_WIDTH]; /* (v, u, w), real form (mhb/numerics/fourier.h), m */
  double
      /* change of a coefficient without effect on the transitions, m; 0: at a switch, up to
       * round-off */
      room;
} suite_motion;

int suite_size(void);

/* Motion i, with 0 <= i < suite_size(). */
suite_motion suite_at(int i);

/* Adds a cos(kt + phase) to axis 0, 1, 2 (v, u, w); k = 0: the mean a. */
void suite_add(suite_motion *s, int axis, int k, double a, double phase);

#endif
