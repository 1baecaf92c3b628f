/* Distance of two curves, amplitude over frequency.
 *
 * The distance of two points is the larger of |ln f1 - ln f2| and |a1 - a2|/unit. Both are
 * relative: 0.01 is 1 % of the frequency or of the largest amplitude. A difference at equal
 * frequency jumps where a curve jumps. This distance is defined on folded curves too, and vanishes
 * with the shift of a steep flank. */
#ifndef POSTPROC_ANALYSIS_CURVE_DISTANCE_H
#define POSTPROC_ANALYSIS_CURVE_DISTANCE_H

typedef struct {
  int           n;
  const double *frequency, *amplitude; /* [n], in order along the curve */
} post_polyline;

/* Distance of two points (f, a). */
double post_point_distance(const double one[2], const double other[2], double unit);

/* Distance of a point from a polyline; INFINITY if that has no point. *nearest (may be NULL): index
 * of the nearest point, or of the nearer end of the nearest segment. */
double post_curve_distance(const double point[2], const post_polyline *line, double unit,
                           int *nearest);

/* Estimated deviation of the curve from the chord between points i and i + 1. On either side a
 * parabola runs through a third point. The larger deviation of the two at the middle is taken. */
double post_chord_deviation(const post_polyline *line, int i, double unit);

#endif
