/* A response as the harmonic balance might leave it, from closed forms: a resonance that stiffens from open to stuck
 * as the preload grows, bends (folds) in between and is damped most in the middle. */
#ifndef TESTS_SUPPORT_FIXTURE_H
#define TESTS_SUPPORT_FIXTURE_H

#include "mhb/response/response.h"

typedef struct {
  int           n_preloads, n_points; /* of each nonlinear branch */
  const double *n0;                   /* N */
  int           n_probes, n_pairs, n_harmonics;
  bool          limits;     /* open and stuck */
  bool          incomplete; /* the last nonlinear branch stops half way */
  double        scale;      /* of all motion; 0: nothing moves */
  mhb_parameter
      parameter; /* followed at 240 Hz, over its range as else the frequency from 92 to 138 Hz */
} fixture_options;

/* Bent resonance in slow-flow form: amplitude a = top sin(theta), frequency f = centre + bend a^2 - width cot(theta), theta in
 * (0, pi). Its peak is a = top at centre + bend top^2; its folds are where 2 bend top^2 sin^3 cos + width = 0. */
typedef struct {
  double top, centre, bend, width;
} fixture_curve;

extern const double fixture_range[MHB_N_PARAMETERS][2];

double fixture_frequency(const fixture_curve *curve, double theta);
double fixture_amplitude(const fixture_curve *curve, double theta);
/* The theta in (lo, hi) where df/dtheta changes sign, by bisection to rounding. */
double fixture_fold(const fixture_curve *curve, double lo, double hi);

/* Everything as in the header's description; NULL when out of memory. */
mhb_response   *fixture_response(const fixture_options *options);
fixture_options fixture_usual(
    void); /* 7 preloads, 240 points, 2 probes, 1 pair, 3 harmonics, limits, incomplete */

/* The case text that tries to break out of a page. */
extern const char fixture_hostile[];

#endif
