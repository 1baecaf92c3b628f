#include "postproc/analysis/curve_distance.h"

#include <math.h>

double post_point_distance(const double one[2], const double other[2], double unit) {
  return fmax(fabs(log(one[0] / other[0])), fabs(one[1] - other[1]) / unit);
}

/* Maximum-norm distance of the origin from the segment (x, y) + t (dx, dy), t in [0, 1]. It is
 * convex and piecewise linear in t: its minimum is at an end, or where a coordinate vanishes, or
 * where both have equal magnitude. */
static double from_segment(double x, double y, double dx, double dy, double *at) {
  double t[6]  = {0, 1, -x / dx, -y / dy, (y - x) / (dx - dy), -(x + y) / (dx + dy)};
  double least = INFINITY;
  for (int i = 0; i < 6; i++) {
    if (!(t[i] >= 0 && t[i] <= 1)) continue;
    double d = fmax(fabs(x + t[i] * dx), fabs(y + t[i] * dy));
    if (d >= least) continue;
    least = d;
    *at   = t[i];
  }
  return least;
}

double post_curve_distance(const double point[2], const post_polyline *line, double unit,
                           int *nearest) {
  double least = INFINITY, x0 = 0, y0 = 0;
  for (int i = 0; i < line->n; i++) {
    double x = log(line->frequency[i] / point[0]), y = (line->amplitude[i] - point[1]) / unit;
    double at = 1, d = i == 0 ? fmax(fabs(x), fabs(y)) : from_segment(x0, y0, x - x0, y - y0, &at);
    if (d < least) {
      least = d;
      if (nearest) *nearest = at < 0.5 ? i - 1 : i;
    }
    x0 = x;
    y0 = y;
  }
  return least;
}

/* Deviation from the chord, at the middle of [a, b], of the parabola through a, b and c. Per
 * coordinate it is (s_b - s_a)^2/4 times the second divided difference over arclength s. */
static double bulge(const double a[2], const double b[2], const double c[2]) {
  double ab = hypot(b[0] - a[0], b[1] - a[1]), bc = hypot(c[0] - b[0], c[1] - b[1]), most = 0;
  if (!(ab > 0 && bc > 0)) return 0;
  for (int i = 0; i < 2; i++) {
    double second = ((c[i] - b[i]) / bc - (b[i] - a[i]) / ab) / (ab + bc);
    most          = fmax(most, fabs(second) * ab * ab / 4);
  }
  return most;
}

double post_chord_deviation(const post_polyline *line, int i, double unit) {
  double p[4][2];
  for (int k = 0; k < 4; k++) {
    int j   = i - 1 + k < 0 ? 0 : i - 1 + k >= line->n ? line->n - 1 : i - 1 + k;
    p[k][0] = log(line->frequency[j]);
    p[k][1] = line->amplitude[j] / unit;
  }
  return fmax(bulge(p[1], p[2], p[3]), bulge(p[2], p[1], p[0]));
}
