/* Peaks and folds of one curve, amplitude against x (the frequency, or another parameter that is followed), given as points in
 * order along it. */
#ifndef POSTPROC_ANALYSIS_CURVES_H
#define POSTPROC_ANALYSIS_CURVES_H

#include <stdbool.h>

#include "mesh/base/status.h"

typedef struct {
  double at, amplitude; /* refined between points: of x, unit of the curve */
  double
      bandwidth; /* of x between the half-power points (amplitude / sqrt 2); NAN if either side does not fall that far
                       before the curve ends, rises again or turns back */
  double
      damping; /* bandwidth / (2 at); over frequency the damping ratio of a linear resonance as wide */
  int  point; /* nearest point */
  bool edge;  /* the curve's largest value, at its end: the peak itself may lie outside the range */
  bool level; /* the whole curve has this value (within 1e-6); edge is set too */
} post_peak;

typedef struct {
  double at, amplitude; /* refined */
  int    point;         /* nearest point */
  bool   upper;         /* x has a maximum here: a sweep upwards falls off; else downwards */
} post_fold;

/* Between points i and i + 1 (false if there are no such) the curve was outside its range: it left it and came back at the same
 * end: just two points at one x, of different amplitude, and x turns there. It folds there an odd number of times, and what follows is a piece of its own. */
bool post_left_range(int n, const double *x, const double *amplitude, int i);

/* Local maxima in order along the curve, less the ripples (that rise by less than 2 % of their height above the deeper
 * neighbouring valley; the largest value of all is none), plus the edge peak if the largest value of all is at an end.
 *   x, amplitude    in   [n], amplitude >= 0
 *   peaks, n_peaks  out  malloc'ed, NULL if none
 * A peak is the vertex of the parabola of 1/amplitude^2 (exact near a resonance) through three points, over x,
 * or over arclength where x turns: the amplitude's error falls with the third power or better of the
 * spacing, that of x with the second or better.
 * Errors: SHB_ERR_IO (no memory). */
shb_status post_find_peaks(int n, const double *x, const double *amplitude, post_peak **peaks,
                           int *n_peaks);

/* Turning points of x, in order, found by its change of direction or by special[i] == 1 (may be NULL);
 * refined by a parabola over amplitude, or arclength, unless flagged (a flagged point was located by the solver).
 * Pairs less than 1e-5 of x (1e-7 of its range, near 0) apart are left out: no jump could be seen there. */
shb_status post_find_folds(int n, const double *x, const double *amplitude, const int *special,
                           post_fold **folds, int *n_folds);

/* Index of the highest peak, -1 if none. */
int post_highest_peak(int n_peaks, const post_peak *peaks);

#endif
