#include "modal/cyclic/wave_operator.h"

#include <cblas.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

static const double complex one = 1, zero = 0;

static shb_status factorise(const fem_hermitian_order *order, wave_operator *op) {
  double complex(*value)[9] = shb_alloc((size_t)op->sector->n_coupled + 1, sizeof *value);
  fem_sector_coupled(op->sector, op->phase, value);
  op->factor = fem_hermitian_create(order, conj(op->phase), (const double complex(*)[9])value);
  free(value);
  SHB_CHECK(op->factor, SHB_ERR_INPUT,
            "the stiffness matrix of the sector is not positive definite: the clamp on group root "
            "does not hold the disc, the material is not physical, or the equilibrium at "
            "rotor.speed is not stable");
  return SHB_OK;
}

shb_status wave_operator_create(const fem_sector *sector, const fem_hermitian_order *order, int n,
                                int blades, wave_operator *op) {
  *op = (wave_operator){
      .sector = sector, .phase = fem_sector_phase(n, blades), .order = 3 * (size_t)sector->n_rows};
  op->is_real = cimag(op->phase) == 0;
  return factorise(order, op);
}

void wave_operator_solve(wave_operator *op, int columns, const double complex *B,
                         double complex *X) {
  fem_hermitian_solve(op->factor, columns, B, X);
}

void wave_operator_mass(wave_operator *op, int columns, const double complex *X,
                        double complex *Y) {
  if (op->columns < columns) {
    free(op->scratch);
    op->scratch = shb_alloc(fem_sector_scratch(op->sector, columns), sizeof *op->scratch);
    op->columns = columns;
  }
  fem_sector_mass(op->sector, op->phase, columns, X, Y, op->scratch);
}

void wave_inner(size_t order, int nx, const double complex *X, int ny, const double complex *Y,
                double complex *C) {
  const int n = (int)order;
  if (nx > 0 && ny > 0)
    cblas_zgemm(CblasColMajor, CblasConjTrans, CblasNoTrans, nx, ny, n, &one, X, n, Y, n, &zero, C,
                nx);
}

void wave_add(size_t order, double factor, int nx, const double complex *X, const double complex *C,
              int ny, double complex *Y) {
  const int            n     = (int)order;
  const double complex alpha = factor;
  if (nx > 0 && ny > 0)
    cblas_zgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, ny, nx, &alpha, X, n, C, nx, &one, Y,
                n);
}

void wave_operator_free(wave_operator *op) {
  fem_hermitian_free(op->factor);
  free(op->scratch);
  memset(op, 0, sizeof *op);
}
