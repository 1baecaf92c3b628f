/* Basis of a block Krylov method for T = (K - shift M)^-1 M: M-orthonormal blocks, and T projected
 * on them. */
#ifndef MODAL_EIGEN_BLOCK_BASIS_H
#define MODAL_EIGEN_BLOCK_BASIS_H

#include <petscksp.h>
#include <stdbool.h>
#include <stdint.h>

#include <petscblaslapack.h> /* after what it needs */

/* The blocks of the projection: T Q_k = Q_(k-1) B_(k-1)^T + Q_k D_k + Q_(k+1) B_k. */
typedef struct {
  MPI_Comm     comm;
  PetscInt     order;       /* of K */
  PetscBLASInt rows, p;     /* rows of this rank; columns per block */
  int          n, capacity; /* blocks used; blocks there is memory for */
  Mat          M, W, MW;    /* block under construction and its product with M, [rows][p] */
  KSP          ksp;         /* solves with K - shift M */
  double     **Q;           /* [n] blocks [p][rows] */
  double      *D, *B;       /* [capacity] blocks, each [p][p] by columns */
  double      *H;           /* [p n][p n] projection, then its eigenvectors */
  double      *theta;       /* [p n], ascending */
} modal_block_basis;

/* Create an empty basis with memory for capacity blocks. M and ksp are borrowed. */
PetscErrorCode modal_block_basis_create(Mat M, KSP ksp, int p, int capacity, modal_block_basis *b);

PetscErrorCode modal_block_basis_destroy(modal_block_basis *b); /* also on a zeroed struct */

/* Fill W with normally distributed random numbers of variance 1, different for each seed. */
PetscErrorCode modal_block_basis_randomise(const modal_block_basis *b, uint64_t seed);

/* MW = M W */
PetscErrorCode modal_block_basis_apply_mass(const modal_block_basis *b);

/* out = X^T Y, [p][p] by columns, summed over the ranks; X, Y [p][rows]. */
PetscErrorCode modal_block_basis_inner(const modal_block_basis *b, const double *X, const double *Y,
                                       double *out);

/* W -= Q Q^T M W, with MW = M W on entry to the projection. */
PetscErrorCode modal_block_basis_project_out(const modal_block_basis *b);

/* Cholesky QR in the M inner product: W = W' R with W'^T M W' = 1, MW = M W alike. MW = M W on
 * entry. product = R product. *good is false if W has not full rank. */
PetscErrorCode modal_block_basis_cholesky_qr(const modal_block_basis *b, double *product,
                                             bool *good);

/* Orthonormalise W against the basis and in itself: W = Q C + W' R.
 *   D  in/out  the coefficients of the last block are added; NULL: W is no step of Lanczos */
PetscErrorCode modal_block_basis_orthonormalise(const modal_block_basis *b, double *D, double *R,
                                                bool *good);

/* Append W to the basis as the next block. */
PetscErrorCode modal_block_basis_append(modal_block_basis *b);

/* H [p n][p n] from the n blocks D and B; lower triangle, by columns. */
void modal_block_basis_projection(int p, int n, const double *D, const double *B, double *H);

#endif
