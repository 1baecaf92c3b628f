#include "mesh/base/axes.h"

#include <math.h>

#include "mesh/base/vec3.h"

void mesh_axis_vector(mesh_axis axis, double axial[3]) {
  int component = (int)axis % 3;
  for (int i = 0; i < 3; i++) axial[i] = 0;
  axial[component] = axis < MESH_AXIS_MX ? 1 : -1;
}

void mesh_axes_at(mesh_axis axis, const double point[3], double axes[3][3]) {
  double *tangential = axes[0], *axial = axes[1], *radial = axes[2];
  mesh_axis_vector(axis, axial);
  const double along = vec3_dot(point, axial);
  for (int i = 0; i < 3; i++) radial[i] = point[i] - along * axial[i];
  const double length = vec3_norm(radial);
  for (int i = 0; i < 3; i++) radial[i] /= length;
  vec3_cross(axial, radial, tangential);
}

void mesh_axis_rotate(mesh_axis axis, double angle, const double point[3], double out[3]) {
  double a[3], axp[3];
  mesh_axis_vector(axis, a);
  vec3_cross(a, point, axp);
  double along = vec3_dot(a, point), c = cos(angle), s = sin(angle);
  for (int i = 0; i < 3; i++) out[i] = c * point[i] + s * axp[i] + (1 - c) * along * a[i];
}

void mesh_axis_matrix(mesh_axis axis, double angle, double matrix[16]) {
  for (int i = 0; i < 16; i++) matrix[i] = i == 15;
  for (int column = 0; column < 3; column++) {
    double unit[3] = {column == 0, column == 1, column == 2};
    mesh_axis_rotate(axis, angle, unit, unit);
    for (int row = 0; row < 3; row++) matrix[4 * row + column] = unit[row];
  }
}

void mesh_axis_stacking(mesh_axis axis, double radial[3]) {
  int component = axis % 3 == MESH_AXIS_Z ? 0 : 2;
  for (int i = 0; i < 3; i++) radial[i] = i == component;
}
