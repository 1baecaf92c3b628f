/* How far apart two curves are, amplitude against frequency.
 *
 * The distance of two points is the greater of |ln f1 - ln f2| and |a1 - a2|/unit: both relative, so that a distance of 0.01
 * is one per cent, of frequency or of the largest amplitude. Unlike a difference at equal frequency it does not jump where a curve
 * does: it is defined on folded curves, and goes to zero with the shift of a steep flank. */
#ifndef POSTPROC_ANALYSIS_CURVE_DISTANCE_H
#define POSTPROC_ANALYSIS_CURVE_DISTANCE_H

typedef struct {
  int           n;
  const double *frequency, *amplitude; /* [n], in order along the curve */
} post_polyline;

/* Of two points (f, a). */
double post_point_distance(const double one[2], const double other[2], double unit);

/* Of a point from the nearest place of a polyline; INFINITY if that has no point. *nearest: the end of the segment that is
 * nearer to it, or the point (may be NULL). */
double post_curve_distance(const double point[2], const post_polyline *line, double unit,
                           int *nearest);

/* How far the curve may be from the chord between points i and i + 1: the deviation of the middle from the parabolas through a
 * third point on either side, the larger of the two. */
double post_chord_deviation(const post_polyline *line, int i, double unit);

#endif
