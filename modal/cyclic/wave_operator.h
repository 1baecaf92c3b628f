/* K(theta)^-1 and M(theta) of a sector at one nodal diameter, on blocks of complex vectors.
 *
 * A block is [columns][order], order = 3 block rows. Free of PETSc: several threads may each have
 * an operator of one sector. */
#ifndef MODAL_CYCLIC_WAVE_OPERATOR_H
#define MODAL_CYCLIC_WAVE_OPERATOR_H

#include "fem/body/sector.h"
#include "fem/solver/hermitian.h"

typedef struct {
  const fem_sector *sector;
  double complex    phase;   /* e^(-j theta), theta = 2 pi n/N */
  bool              is_real; /* at nodal diameters 0 and N/2: all vectors may be real */
  size_t            order;
  fem_hermitian    *factor;  /* of K(theta) */
  double           *scratch; /* of products with M of columns columns */
  int               columns;
} wave_operator;

/* Factorise K(theta) of nodal diameter n of N blades; order: of sector->blocks. Errors:
 * SHB_ERR_INPUT not positive definite. */
shb_status wave_operator_create(const fem_sector *sector, const fem_hermitian_order *order, int n,
                                int blades, wave_operator *op);

/* X = K^-1 B; X may be B. */
void wave_operator_solve(wave_operator *op, int columns, const double complex *B,
                         double complex *X);

/* Y = M X, different blocks. */
void wave_operator_mass(wave_operator *op, int columns, const double complex *X, double complex *Y);

/* C = X^H Y: [y columns][x columns], by columns. */
void wave_inner(size_t order, int nx, const double complex *X, int ny, const double complex *Y,
                double complex *C);

/* Y += factor X C, C [y columns][x columns] by columns. */
void wave_add(size_t order, double factor, int nx, const double complex *X, const double complex *C,
              int ny, double complex *Y);

void wave_operator_free(wave_operator *op); /* also on a zeroed struct */

#endif
