/* Basis of a block Krylov method for the complex Hermitian pencil of a wave: the complex form of
 * modal/eigen/block_basis.h.
 *
 * Stored as pairs (Re, Im), a complex block is one of 2 p real columns that is closed under
 * multiplication by j. So each mode is found once, not as the pair x, jx. */
#ifndef MODAL_CYCLIC_WAVE_BASIS_H
#define MODAL_CYCLIC_WAVE_BASIS_H

#include <stdint.h>

#include "modal/cyclic/wave_operator.h"

/* The projection: T Q_k = Q_(k-1) B_(k-1)^H + Q_k D_k + Q_(k+1) B_k, T = K^-1 M. */
typedef struct {
  wave_operator  *op;
  size_t          order;
  int             p, n, capacity; /* columns per block; blocks used; blocks there is memory for */
  double complex *W, *MW;         /* [p][order] block under construction, and its product with M */
  double complex *Q;              /* [capacity][p][order] */
  double complex *D, *B;          /* [capacity] blocks, each [p][p] by columns */
  double complex *H;              /* [p n][p n] projection, then its eigenvectors */
  double         *theta;          /* [p n], ascending */
  double complex *C;              /* [p][p capacity] scratch */
} wave_basis;

/* Create an empty basis; op is borrowed. */
void wave_basis_create(wave_operator *op, int p, int capacity, wave_basis *b);
void wave_basis_free(wave_basis *b); /* also on a zeroed struct */

/* Fill W with complex normally distributed numbers, different for each seed. They are real where
 * the matrices are: then all shapes are real without rounding. */
void wave_basis_randomise(const wave_basis *b, uint64_t seed);

/* W -= Q Q^H M W, with MW = M W on entry to the projection. The coefficients of the last block are
 * added to last (or NULL). */
void wave_basis_project_out(wave_basis *b, double complex *last);

/* Cholesky QR in the M inner product: W = W' R, W'^H M W' = 1, MW alike. MW = M W on entry. product
 * = R product. *good is false if W has not full rank. */
void wave_basis_cholesky_qr(wave_basis *b, double complex *product, bool *good);

/* Orthonormalise W against the basis and in itself: W = Q C + W' R. The coefficients of the last
 * block are added to D (or NULL). */
void wave_basis_orthonormalise(wave_basis *b, double complex *D, double complex *R, bool *good);

/* Append W to the basis as the next block. */
void wave_basis_append(wave_basis *b);

/* H [p n][p n] from the n blocks D and B; lower triangle, by columns. */
void wave_basis_projection(int p, int n, const double complex *D, const double complex *B,
                           double complex *H);

#endif
