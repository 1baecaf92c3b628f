/* The basis of a block Krylov method for T = (K - shift M)^-1 M: blocks orthonormal in M, and T projected on them. */
#ifndef MODAL_EIGEN_BLOCK_BASIS_H
#define MODAL_EIGEN_BLOCK_BASIS_H

#include <petscksp.h>
#include <stdbool.h>
#include <stdint.h>

#include <petscblaslapack.h> /* after what it needs */

/* Diagonal blocks D_k and blocks B_k below them, T Q_k = Q_k-1 B_k-1^T + Q_k D_k + Q_k+1 B_k. */
typedef struct {
  MPI_Comm     comm;
  PetscInt     order;    /* of K */
  PetscBLASInt rows, p;  /* own rows; columns a block */
  int          n, room;  /* blocks */
  Mat          M, W, MW; /* the block in the making, and M times it: [rows][p] */
  KSP          ksp;      /* solves with K - shift M */
  double     **Q;        /* [n] blocks [p][rows] */
  double      *D, *B;    /* [room] blocks, each [p][p] by columns */
  double      *H;        /* [p n][p n], later its eigenvectors */
  double      *theta;    /* [p n], ascending */
} modal_block_basis;

/* Empty, with room for so many blocks. M and ksp are borrowed. */
PetscErrorCode modal_block_basis_create(Mat M, KSP ksp, int p, int room, modal_block_basis *b);

PetscErrorCode modal_block_basis_destroy(modal_block_basis *b); /* also on a zeroed struct */

/* W: numbers without structure, of variance 1; others for each seed. */
PetscErrorCode modal_block_basis_randomise(const modal_block_basis *b, uint64_t seed);

/* MW = M W */
PetscErrorCode modal_block_basis_apply_mass(const modal_block_basis *b);

/* out = X^T Y, [p][p] by columns, summed over the ranks; X, Y [p][rows]. */
PetscErrorCode modal_block_basis_inner(const modal_block_basis *b, const double *X, const double *Y,
                                       double *out);

/* MW = M W, W -= Q Q^T M W; what the last block took of it is added to last (NULL: not wanted). */
PetscErrorCode modal_block_basis_project_out(const modal_block_basis *b, double *last);

/* W = W' R, W'^T M W' = 1, and MW (M W on entry) with it; product = R product. *good false: W has not full rank. */
PetscErrorCode modal_block_basis_cholesky_qr(const modal_block_basis *b, double *product,
                                             bool *good);

/* Make W orthonormal to the basis and in itself: W = Q C + W' R. D: what the last block takes of it is added (NULL: not wanted). */
PetscErrorCode modal_block_basis_orthonormalise(const modal_block_basis *b, double *D, double *R,
                                                bool *good);

/* Keep W as the next block. */
PetscErrorCode modal_block_basis_append(modal_block_basis *b);

/* H [p n][p n], lower triangle by columns, from its n blocks D, B. */
void modal_block_basis_projection(int p, int n, const double *D, const double *B, double *H);

#endif
