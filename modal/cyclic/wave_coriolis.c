#include "modal/cyclic/wave_coriolis.h"

#include <stdlib.h>

#include "mesh/base/memory.h"

/* Y = G X from MX = M X, one block row at a time. */
static void turn(const fem_rotation *rotation, fem_turning turning, size_t rows,
                 const double complex *MX, double complex *Y) {
  for (size_t i = 0; i < rows; i++) {
    double part[2][3];
    for (int d = 0; d < 3; d++) {
      part[0][d] = creal(MX[3 * i + (size_t)d]);
      part[1][d] = cimag(MX[3 * i + (size_t)d]);
    }
    for (int p = 0; p < 2; p++) {
      double force[3];
      fem_rotation_coriolis(rotation, turning, part[p], force);
      for (int d = 0; d < 3; d++) part[p][d] = force[d];
    }
    for (int d = 0; d < 3; d++) Y[3 * i + (size_t)d] = CMPLX(part[0][d], part[1][d]);
  }
}

void wave_coriolis(const wave_modes *modes, const fem_rotation *rotation, fem_turning turning,
                   double *re, double *im) {
  const size_t    m = (size_t)modes->n, size = m * modes->order;
  double complex *Y = shb_alloc(size + 1, sizeof *Y), *C = shb_alloc(m * m + 1, sizeof *C);
  turn(rotation, turning, size / 3, modes->m_phi, Y);
  wave_inner(modes->order, modes->n, modes->phi, modes->n, Y, C); /* phi_i^H Y_j at [j][i] */
  for (size_t i = 0; i < m; i++)
    for (size_t j = 0; j < m; j++) { /* rounding differences go */
      const double complex value = (C[j * m + i] - conj(C[i * m + j])) / 2;
      re[i * m + j]              = creal(value);
      if (im) im[i * m + j] = cimag(value);
    }
  free(Y);
  free(C);
}
