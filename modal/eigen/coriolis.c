#include "modal/eigen/coriolis.h"

#include <petscblaslapack.h>

/* out[rows] = G phi from M phi, a node at a time. */
static void turn(const fem_rotation *rotation, fem_turning turning, PetscInt rows, const double *mv,
                 double *out) {
  for (PetscInt i = 0; i < rows; i += 3) fem_rotation_coriolis(rotation, turning, mv + i, out + i);
}

/* matrix[i][j] += phi_i^T G phi_j of the rows of this rank. */
static PetscErrorCode add_products(const modal_eigen *eigen, const fem_rotation *rotation,
                                   fem_turning turning, double *matrix) {
  const double      *phi, *m_phi;
  double            *y;
  PetscInt           rows, lda, m_lda;
  const PetscBLASInt one = 1;
  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(eigen->phi, &rows, NULL));
  PetscCall(MatDenseGetLDA(eigen->phi, &lda));
  PetscCall(MatDenseGetLDA(eigen->m_phi, &m_lda));
  PetscCall(MatDenseGetArrayRead(eigen->phi, &phi));
  PetscCall(MatDenseGetArrayRead(eigen->m_phi, &m_phi));
  PetscCall(PetscMalloc1(rows + 1, &y));
  const PetscBLASInt n = (PetscBLASInt)rows;
  for (int j = 0; j < eigen->n; j++) {
    turn(rotation, turning, rows, m_phi + (size_t)j * (size_t)m_lda, y);
    for (int i = 0; i < eigen->n; i++)
      matrix[(size_t)i * (size_t)eigen->n + (size_t)j] +=
          BLASdot_(&n, phi + (size_t)i * (size_t)lda, &one, y, &one);
  }
  PetscCall(PetscFree(y));
  PetscCall(MatDenseRestoreArrayRead(eigen->m_phi, &m_phi));
  PetscCall(MatDenseRestoreArrayRead(eigen->phi, &phi));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_coriolis(const modal_eigen *eigen, const fem_rotation *rotation,
                              fem_turning turning, double *matrix) {
  const size_t n = (size_t)eigen->n;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(matrix, n * n));
  PetscCall(add_products(eigen, rotation, turning, matrix));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, matrix, (int)(n * n), MPI_DOUBLE, MPI_SUM,
                             PetscObjectComm((PetscObject)eigen->phi)));
  for (size_t i = 0; i < n; i++) /* rounding differences go */
    for (size_t j = 0; j <= i; j++) {
      const double value = (matrix[i * n + j] - matrix[j * n + i]) / 2;
      matrix[i * n + j]  = value;
      matrix[j * n + i]  = -value;
    }
  PetscFunctionReturn(0);
}
