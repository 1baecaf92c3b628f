#include "fem/element/material.h"

#include <math.h>
#include <string.h>

#include "mesh/base/vec3.h"

static const int place[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};

/* Inverse of the normal part of the compliance. False unless it is positive definite. */
static bool invert(const double S[3][3], double C[3][3]) {
  double minor = S[0][0] * S[1][1] - S[0][1] * S[1][0], det = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      C[j][i] = S[i1][j1] * S[i2][j2] - S[i1][j2] * S[i2][j1];
    }
  for (int i = 0; i < 3; i++) det += S[0][i] * C[i][0];
  if (!(S[0][0] > 0 && minor > 0 && det > 0)) return false;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) C[i][j] /= det;
  return true;
}

/* Stiffness in material axes. The compliance is scaled by E1, so that determinants are near 1. */
static shb_status stiffness_in_own_axes(const fem_orthotropic *from, double C[6][6]) {
  const double *E = from->E, *nu = from->nu, scale = E[0];
  double        S[3][3], normal[3][3];
  memset(C, 0, 36 * sizeof(double));
  for (int i = 0; i < 3; i++) S[i][i] = scale / E[i];
  S[0][1] = S[1][0] = -nu[0] * scale / E[0];
  S[0][2] = S[2][0] = -nu[1] * scale / E[0];
  S[1][2] = S[2][1] = -nu[2] * scale / E[1];
  bool positive     = E[0] > 0 && E[1] > 0 && E[2] > 0 && invert((const double(*)[3])S, normal);
  for (int i = 0; i < 3; i++) positive = positive && from->G[i] > 0;
  SHB_CHECK(positive, SHB_ERR_INPUT,
            "E, nu and G are those of no stable material (the stiffness is not positive "
            "definite); nu12 is the contraction along 2 under tension along 1, nu12/E1 = nu21/E2");
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) C[i][j] = scale * normal[i][j];
  for (int i = 0; i < 3; i++) C[3 + i][3 + i] = from->G[i];
  return SHB_OK;
}

/* Rows: the material axes in mesh axes. */
static shb_status find_axes(const fem_orthotropic *from, double axes[3][3]) {
  const double first = vec3_norm(from->axis);
  for (int d = 0; d < 3; d++) axes[0][d] = from->axis[d] / first;
  const double along = vec3_dot(axes[0], from->in_plane);
  for (int d = 0; d < 3; d++) axes[1][d] = from->in_plane[d] - along * axes[0][d];
  const double second = vec3_norm(axes[1]);
  SHB_CHECK(first > 0 && second > 1e-6 * fabs(along), SHB_ERR_INPUT,
            "axis_1 and axis_2 must be two directions, not along one line");
  for (int d = 0; d < 3; d++) axes[1][d] /= second;
  vec3_cross(axes[0], axes[1], axes[2]);
  return SHB_OK;
}

/* c_ijkl = r_ai r_bj r_ck r_dl C_abcd for one (ij, kl). */
static double rotated(const double C[6][6], const double axes[3][3], int i, int j, int k, int l) {
  double sum = 0;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      for (int c = 0; c < 3; c++)
        for (int d = 0; d < 3; d++)
          sum += axes[a][i] * axes[b][j] * axes[c][k] * axes[d][l] * C[place[a][b]][place[c][d]];
  return sum;
}

shb_status fem_material_orthotropic(const fem_orthotropic *from, double rho, fem_material *out) {
  static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  double           C[6][6], axes[3][3];
  SHB_TRY(stiffness_in_own_axes(from, C));
  SHB_TRY(find_axes(from, axes));
  *out = (fem_material){
      .E = fmax(from->E[0], fmax(from->E[1], from->E[2])), .rho = rho, .anisotropic = true};
  for (int p = 0; p < 6; p++)
    for (int q = p; q < 6; q++)
      out->C[p][q] = out->C[q][p] = rotated((const double(*)[6])C, (const double(*)[3])axes,
                                            pair[p][0], pair[p][1], pair[q][0], pair[q][1]);
  return SHB_OK;
}
