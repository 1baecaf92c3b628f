#include "fem/rotation.h"

void fem_rotation_square(const fem_rotation *rotation, double square[3]) {
  double axial[3];
  mesh_axis_vector(rotation->axis, axial);
  for (int d = 0; d < 3; d++) square[d] = axial[d] == 0 ? rotation->speed * rotation->speed : 0;
}

void fem_tet10_centrifugal(const fem_rotation *rotation, const double m[10][10],
                           const double x[10][3], const double u[10][3], double f[10][3]) {
  double square[3];
  fem_rotation_square(rotation, square);
  for (int i = 0; i < 10; i++)
    for (int d = 0; d < 3; d++) {
      double sum = 0;
      for (int j = 0; j < 10; j++) sum += m[i][j] * (x[j][d] + u[j][d]);
      f[i][d] = square[d] * sum;
    }
}

void fem_tet10_soften(const fem_rotation *rotation, const double m[10][10], double K[30][30]) {
  double square[3];
  fem_rotation_square(rotation, square);
  for (int i = 0; i < 10; i++)
    for (int j = 0; j < 10; j++)
      for (int d = 0; d < 3; d++) K[3 * i + d][3 * j + d] -= square[d] * m[i][j];
}
