#include "mesh/core/triangle.h"

#include <math.h>

#include "mesh/base/vec3.h"

static const int six[4][3]   = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
static const int eight[6][3] = {{0, 4, 7}, {4, 1, 5}, {5, 2, 6}, {6, 3, 7}, {4, 5, 6}, {4, 6, 7}};

int mesh_triangles(const mesh_fe *mesh, const int *face, mesh_triangle part[MESH_TRIANGLES]) {
  const int(*cut)[3] = mesh->kind == MESH_HEX20 ? eight : six;
  const int n        = mesh->kind == MESH_HEX20 ? 6 : 4;
  for (int p = 0; p < n; p++)
    for (int c = 0; c < 3; c++) {
      part[p].local[c] = cut[p][c];
      part[p].x[c]     = mesh->coordinates + 3 * (size_t)face[cut[p][c]];
    }
  return n;
}

void mesh_triangle_area(const mesh_triangle *triangle, double area[3]) {
  double a[3], b[3];
  vec3_minus(triangle->x[1], triangle->x[0], a);
  vec3_minus(triangle->x[2], triangle->x[0], b);
  vec3_cross(a, b, area);
  for (int d = 0; d < 3; d++) area[d] /= 2;
}

static double distance(const mesh_triangle *triangle, const double at[3], const double weight[3],
                       double foot[3]) {
  for (int d = 0; d < 3; d++) {
    foot[d] = 0;
    for (int c = 0; c < 3; c++) foot[d] += weight[c] * triangle->x[c][d];
  }
  return vec3_distance(foot, at);
}

/* Barycentric coordinates of the nearest point on the side from corner c to the next. */
static void on_side(const mesh_triangle *triangle, const double at[3], int c, double weight[3]) {
  double along[3], from[3];
  int    next = (c + 1) % 3;
  vec3_minus(triangle->x[next], triangle->x[c], along);
  vec3_minus(at, triangle->x[c], from);
  double square       = vec3_dot(along, along);
  double share        = square > 0 ? fmin(1, fmax(0, vec3_dot(from, along) / square)) : 0;
  weight[c]           = 1 - share;
  weight[next]        = share;
  weight[(c + 2) % 3] = 0;
}

/* The foot of the perpendicular if it lies inside, else the nearest point of a side. */
double mesh_triangle_closest(const mesh_triangle *triangle, const double at[3], double foot[3],
                             double weight[3]) {
  double a[3], b[3], v[3], w[3];
  vec3_minus(triangle->x[1], triangle->x[0], a);
  vec3_minus(triangle->x[2], triangle->x[0], b);
  vec3_minus(at, triangle->x[0], v);
  double aa = vec3_dot(a, a), ab = vec3_dot(a, b), bb = vec3_dot(b, b), va = vec3_dot(v, a),
         vb       = vec3_dot(v, b);
  double det      = aa * bb - ab * ab;
  double inner[3] = {0, (bb * va - ab * vb) / det, (aa * vb - ab * va) / det};
  inner[0]        = 1 - inner[1] - inner[2];
  double least    = INFINITY;
  if (det > 0 && inner[0] >= 0 && inner[1] >= 0 && inner[2] >= 0) {
    least = distance(triangle, at, inner, foot);
    for (int c = 0; weight && c < 3; c++) weight[c] = inner[c];
    return least;
  }
  for (int c = 0; c < 3; c++) {
    double there[3];
    on_side(triangle, at, c, w);
    double here = distance(triangle, at, w, there);
    if (here >= least) continue;
    least = here;
    for (int d = 0; d < 3; d++) {
      foot[d] = there[d];
      if (weight) weight[d] = w[d];
    }
  }
  return least;
}
