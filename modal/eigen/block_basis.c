#include "modal/eigen/block_basis.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/body/mass_product.h"
#include "fem/supernodal/large_pages.h"
#include "modal/common/random_vector.h"
#include "modal/eigen/block_products.h"

enum { SLAB = 8 }; /* blocks that share memory: a block alone is too small for large pages */

static const PetscScalar one = 1;

PetscErrorCode modal_block_basis_create(Mat M, KSP ksp, int p, int capacity, modal_block_basis *b) {
  PetscInt rows;
  PetscFunctionBeginUser;
  memset(b, 0, sizeof *b);
  b->p        = (PetscBLASInt)p;
  b->capacity = capacity;
  b->comm     = PetscObjectComm((PetscObject)M);
  b->M        = M;
  b->ksp      = ksp;
  PetscCall(MatGetSize(M, &b->order, NULL));
  PetscCall(MatGetLocalSize(M, &rows, NULL));
  b->rows = (PetscBLASInt)rows;
  PetscCall(MatCreateDense(b->comm, rows, PETSC_DECIDE, b->order, p, NULL, &b->W));
  PetscCall(MatCreateDense(b->comm, rows, PETSC_DECIDE, b->order, p, NULL, &b->MW));
  const size_t m = (size_t)p * (size_t)capacity, each = (size_t)p * (size_t)p;
  PetscCall(PetscCalloc5((size_t)capacity, &b->Q, (size_t)capacity * each, &b->D,
                         (size_t)capacity * each, &b->B, m * m, &b->H, m, &b->theta));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_block_basis_destroy(modal_block_basis *b) {
  PetscFunctionBeginUser;
  for (int k = 0; k < b->n; k += SLAB) free(b->Q[k]);
  PetscCall(PetscFree5(b->Q, b->D, b->B, b->H, b->theta));
  PetscCall(MatDestroy(&b->W));
  PetscCall(MatDestroy(&b->MW));
  memset(b, 0, sizeof *b);
  PetscFunctionReturn(0);
}

/* Normally distributed number (Box and Muller 1958). */
static double normal(uint64_t key) {
  const double u = (modal_random(2 * key) + 1) / 2, v = modal_random(2 * key + 1);
  return sqrt(-2 * log(1 - u)) * cos(PETSC_PI * v);
}

PetscErrorCode modal_block_basis_randomise(const modal_block_basis *b, uint64_t seed) {
  double  *W;
  PetscInt first;
  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(b->W, &first, NULL));
  PetscCall(MatDenseGetArrayWrite(b->W, &W));
#pragma omp parallel for collapse(2) schedule(static)
  for (size_t c = 0; c < (size_t)b->p; c++)
    for (size_t i = 0; i < (size_t)b->rows; i++) {
      const uint64_t key         = ((uint64_t)first + i) * (uint64_t)b->p + (uint64_t)c;
      W[c * (size_t)b->rows + i] = normal(seed * (uint64_t)b->order * (uint64_t)b->p + key);
    }
  PetscCall(MatDenseRestoreArrayWrite(b->W, &W));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_block_basis_apply_mass(const modal_block_basis *b) {
  PetscFunctionBeginUser;
  PetscCall(fem_mass_multiply(b->M, b->W, b->MW));
  PetscFunctionReturn(0);
}

/* out_k = Q_k^T Y for n blocks, sums of all ranks. */
static PetscErrorCode inner_blocks(const modal_block_basis *b, int n, double *const *Q,
                                   const double *Y, double *out) {
  const size_t p = (size_t)b->p;
  PetscFunctionBeginUser;
  modal_block_inner((size_t)b->rows, p, (size_t)n, Q, Y, out);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, out, n * b->p * b->p, MPI_DOUBLE, MPI_SUM, b->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_block_basis_inner(const modal_block_basis *b, const double *X, const double *Y,
                                       double *out) {
  double *block = (double *)X;
  PetscFunctionBeginUser;
  PetscCall(inner_blocks(b, 1, &block, Y, out));
  PetscFunctionReturn(0);
}

/* W -= Q Q^T M W of the blocks from first on, with MW = M W before it. The coefficients of the last
 * block are added to last (or NULL). */
static PetscErrorCode project_out(const modal_block_basis *b, int first, double *last) {
  const size_t  each = (size_t)b->p * (size_t)b->p, n = (size_t)(b->n - first);
  double       *W, *C;
  const double *MW;
  PetscFunctionBeginUser;
  PetscCall(modal_block_basis_apply_mass(b));
  PetscCall(PetscMalloc1(n * each + 1, &C));
  PetscCall(MatDenseGetArray(b->W, &W));
  PetscCall(MatDenseGetArrayRead(b->MW, &MW));
  PetscCall(inner_blocks(b, (int)n, b->Q + first, MW, C));
  modal_block_subtract((size_t)b->rows, (size_t)b->p, n, b->Q + first, C, W);
  for (size_t i = 0; last && n > 0 && i < each; i++) last[i] += C[(n - 1) * each + i];
  PetscCall(MatDenseRestoreArrayRead(b->MW, &MW));
  PetscCall(MatDenseRestoreArray(b->W, &W));
  PetscCall(PetscFree(C));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_block_basis_project_out(const modal_block_basis *b) {
  PetscFunctionBeginUser;
  PetscCall(project_out(b, 0, NULL));
  PetscFunctionReturn(0);
}

/* P = R P; R is upper triangular, both by columns. */
static void multiply_triangle(int p, const double *R, double *P) {
  for (int c = 0; c < p; c++)
    for (int r = 0; r < p; r++) {
      double sum = 0;
      for (int i = r; i < p; i++) sum += R[i * p + r] * P[c * p + i];
      P[c * p + r] = sum;
    }
}

PetscErrorCode modal_block_basis_cholesky_qr(const modal_block_basis *b, double *product,
                                             bool *good) {
  double      *W, *MW, *R;
  PetscBLASInt info;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((size_t)(b->p * b->p), &R));
  PetscCall(MatDenseGetArray(b->W, &W));
  PetscCall(MatDenseGetArray(b->MW, &MW));
  PetscCall(modal_block_basis_inner(b, W, MW, R));
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("U", &b->p, R, &b->p, &info));
  *good = info == 0;
  if (*good) {
    PetscCallBLAS("BLAStrsm",
                  BLAStrsm_("R", "U", "N", "N", &b->rows, &b->p, &one, R, &b->p, W, &b->rows));
    PetscCallBLAS("BLAStrsm",
                  BLAStrsm_("R", "U", "N", "N", &b->rows, &b->p, &one, R, &b->p, MW, &b->rows));
    multiply_triangle((int)b->p, R, product);
  }
  PetscCall(MatDenseRestoreArray(b->MW, &MW));
  PetscCall(MatDenseRestoreArray(b->W, &W));
  PetscCall(PetscFree(R));
  PetscFunctionReturn(0);
}

/* In a step of Lanczos (D) the last two blocks take nearly all of W, by the three-term recurrence.
 * The others have rounding errors of the solve in W, which the second pass removes; without it they
 * would grow from step to step. */
PetscErrorCode modal_block_basis_orthonormalise(const modal_block_basis *b, double *D, double *R,
                                                bool *good) {
  PetscFunctionBeginUser;
  *good = true;
  for (int i = 0; i < b->p * b->p; i++) R[i] = i % (b->p + 1) == 0;
  if (b->n > 0) PetscCall(project_out(b, D && b->n > 2 ? b->n - 2 : 0, D));
  PetscCall(project_out(b, 0, D));
  PetscCall(modal_block_basis_apply_mass(b));
  for (int pass = 0; pass < 2 && *good; pass++)
    PetscCall(modal_block_basis_cholesky_qr(b, R, good));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_block_basis_append(modal_block_basis *b) {
  const double *W;
  const size_t  size = (size_t)b->rows * (size_t)b->p;
  PetscFunctionBeginUser;
  const int slab = b->capacity - b->n < SLAB ? b->capacity - b->n : SLAB;
  b->Q[b->n]     = b->n % SLAB ? b->Q[b->n - 1] + size
                               : fem_large_alloc((size_t)slab * size + 1, sizeof(double));
  PetscCall(MatDenseGetArrayRead(b->W, &W));
  memcpy(b->Q[b->n++], W, size * sizeof *W);
  PetscCall(MatDenseRestoreArrayRead(b->W, &W));
  PetscFunctionReturn(0);
}

void modal_block_basis_projection(int p, int n, const double *D, const double *B, double *H) {
  const size_t each = (size_t)p * (size_t)p, m = (size_t)p * (size_t)n;
  memset(H, 0, m * m * sizeof *H);
  for (int k = 0; k < n; k++, D += each, B += each)
    for (int c = 0; c < p; c++)
      for (int r = 0; r < p; r++) {
        double *column = H + (size_t)(k * p + c) * m + k * p;
        column[r]      = (D[c * p + r] + D[r * p + c]) / 2;
        if (k + 1 < n) column[p + r] = B[c * p + r];
      }
}
