/* A response like that of the harmonic balance, from closed forms. Its resonance stiffens from open
 * to stuck as the preload grows. In between it bends (folds) and has the most damping. */
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
      /* continuation parameter; other than the frequency: at 240 Hz, over fixture_range */
      parameter;
} fixture_options;

/* Bent resonance in slow-flow form, for theta in (0, pi):
 *   amplitude a = top sin(theta),  frequency f = centre + bend a^2 - width cot(theta)
 * Its peak is a = top at centre + bend top^2. Its folds obey 2 bend top^2 sin^3 cos = -width. */
typedef struct {
  double top, centre, bend, width;
} fixture_curve;

extern const double fixture_range[MHB_N_PARAMETERS][2];

double fixture_frequency(const fixture_curve *curve, double theta);
double fixture_amplitude(const fixture_curve *curve, double theta);
/* The theta in (lo, hi) at which df/dtheta changes sign, by bisection to round-off. */
double fixture_fold(const fixture_curve *curve, double lo, double hi);

/* A response as described above; NULL if memory is short. */
mhb_response   *fixture_response(const fixture_options *options);
fixture_options fixture_usual(
    void); /* 7 preloads, 240 points, 2 probes, 1 pair, 3 harmonics, limits, incomplete */

/* A case text that tries to break out of a page. */
extern const char fixture_hostile[];

#endif
