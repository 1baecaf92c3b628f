#include "fem/body/rotation.h"

#include "mesh/base/vec3.h"

void fem_rotation_square(const fem_rotation *rotation, double square[3]) {
  double axial[3];
  mesh_axis_vector(rotation->axis, axial);
  for (int d = 0; d < 3; d++) square[d] = axial[d] == 0 ? rotation->speed * rotation->speed : 0;
}

void fem_rotation_load(const fem_rotation *rotation, int n, const double *m, const double x[][3],
                       const double u[][3], double f[][3]) {
  double square[3];
  fem_rotation_square(rotation, square);
  for (int i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) {
      double sum = 0;
      for (int j = 0; j < n; j++) sum += m[n * i + j] * (x[j][d] + u[j][d]);
      f[i][d] = square[d] * sum;
    }
}

void fem_rotation_soften(const fem_rotation *rotation, int n, const double *m, double *K) {
  double square[3];
  fem_rotation_square(rotation, square);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      for (int d = 0; d < 3; d++) K[(3 * i + d) * 3 * n + 3 * j + d] -= square[d] * m[n * i + j];
}

void fem_rotation_coriolis(const fem_rotation *rotation, fem_turning turning, const double mv[3],
                           double force[3]) {
  double axial[3], product[3];
  mesh_axis_vector(rotation->axis, axial);
  vec3_cross(axial, mv, product);
  const double twice = turning == FEM_TURNS_UNSAID ? 0 : 2 * rotation->speed;
  for (int d = 0; d < 3; d++)
    force[d] = turning == FEM_TURNS_LEFT ? -twice * product[d] : twice * product[d];
}
