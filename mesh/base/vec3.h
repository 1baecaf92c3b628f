/* Vectors with three components, and symmetric tensors of them. */
#ifndef MESH_BASE_VEC3_H
#define MESH_BASE_VEC3_H

#include <math.h>

static inline double vec3_dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* c = a x b; c must be neither a nor b. */
static inline void vec3_cross(const double a[3], const double b[3], double c[3]) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

/* c = a - b; c may be a or b. */
static inline void vec3_minus(const double a[3], const double b[3], double c[3]) {
  for (int d = 0; d < 3; d++) c[d] = a[d] - b[d];
}

static inline double vec3_norm(const double a[3]) {
  return sqrt(vec3_dot(a, a));
}

static inline double vec3_distance(const double a[3], const double b[3]) {
  double c[3];
  vec3_minus(a, b, c);
  return vec3_norm(c);
}

/* s <- R s R^T of the tensor xx, yy, zz, xy, yz, xz. row: the rows of R. */
static inline void vec3_turn_tensor(double row[3][3], double s[6]) {
  static const int place[6][2]  = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  const double     matrix[3][3] = {{s[0], s[3], s[5]}, {s[3], s[1], s[4]}, {s[5], s[4], s[2]}};
  for (int c = 0; c < 6; c++) {
    double half[3];
    for (int d = 0; d < 3; d++) half[d] = vec3_dot(matrix[d], row[place[c][1]]);
    s[c] = vec3_dot(row[place[c][0]], half);
  }
}

#endif
