/* Peaks and folds of one curve: amplitude over x (the frequency or another parameter), points in
 * order along the curve. */
#ifndef POSTPROC_ANALYSIS_CURVES_H
#define POSTPROC_ANALYSIS_CURVES_H

#include <stdbool.h>

#include "mesh/base/status.h"

typedef struct {
  double at, amplitude; /* refined between points: x, and the curve's unit */
  /* Width in x between the half-power points (amplitude / sqrt 2). NAN if either side ends,
   * rises again, or turns back before by more than 1 % of its distance from the peak. */
  double bandwidth;
  /* bandwidth / (2 at): over frequency, the damping ratio of a linear resonance of that
   * width. */
  double damping;
  int    point; /* nearest point */
  bool   edge;  /* largest value, at an end: the peak may lie outside the range */
  bool   level; /* the curve is constant within 1e-6; edge is set too */
} post_peak;

typedef struct {
  double at, amplitude; /* refined */
  int    point;         /* nearest point */
  bool   upper;         /* x has a maximum: an upward sweep jumps here; else a downward one */
} post_fold;

/* True if the curve left its range between points i and i + 1 and returned at the same end. Then
 * exactly two points share x, their amplitudes differ, and x turns there. The curve folds outside,
 * an odd number of times; the rest is a separate piece. */
bool post_left_range(int n, const double *x, const double *amplitude, int i);

/* Find the local maxima in order along the curve. Ripples are left out: they rise by less than 2 %
 * of their height above the deeper neighbouring valley. If the largest value is at an end it is
 * added as an edge peak.
 *
 *   x, amplitude    in   [n], amplitude >= 0
 *   peaks, n_peaks  out  malloc'ed, NULL if there is none
 *
 * A peak is the vertex of the parabola of 1/amplitude^2 (exact near a resonance) through three
 * points, over x, or over arclength where x turns. With the point spacing the amplitude's error is
 * of third order or better, that of x of second order or better. Errors: SHB_ERR_IO no memory. */
shb_status post_find_peaks(int n, const double *x, const double *amplitude, post_peak **peaks,
                           int *n_peaks);

/* Find the turning points of x in order, by its change of direction or by special[i] == 1 (special
 * may be NULL). Unflagged ones are refined by a parabola over amplitude or arclength; flagged ones
 * were located by the solver. Pairs closer than 1e-5 of x (1e-7 of its range, near 0) are left out:
 * their jump is invisible. */
shb_status post_find_folds(int n, const double *x, const double *amplitude, const int *special,
                           post_fold **folds, int *n_folds);

/* Index of the highest peak, -1 if none. */
int post_highest_peak(int n_peaks, const post_peak *peaks);

#endif
