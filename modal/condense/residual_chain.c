#include "modal/condense/residual_chain.h"

#include <cblas.h>
#include <string.h>

#include "fem/body/mass_product.h"

enum { BLOCKS = MODAL_RESIDUAL_BLOCKS, MOMENTS = 2 * BLOCKS + 2 };

PetscErrorCode modal_residual_chain_create(const fem_system *system, const modal_eigen *eigen,
                                           const modal_dofs *at, const modal_dofs *probe, int batch,
                                           modal_residual_chain *chain) {
  const size_t b = (size_t)batch;
  PetscFunctionBeginUser;
  *chain = (modal_residual_chain){
      .system = system, .eigen = eigen, .at = at, .probe = probe, .batch = batch};
  PetscCall(modal_dense_create(system, batch, &chain->B));
  PetscCall(modal_dense_create(system, batch, &chain->X));
  for (int i = 0; i < BLOCKS; i++) {
    PetscCall(PetscMalloc1((size_t)at->n * b, &chain->sample[i]));
    PetscCall(PetscMalloc1((size_t)probe->n * b, &chain->probe_sample[i]));
  }
  for (int i = 0; i < MOMENTS; i++) PetscCall(PetscMalloc1(b * b, &chain->moment[i]));
  PetscFunctionReturn(0);
}

/* Store the samples of V_i. */
static PetscErrorCode sample(const modal_residual_chain *chain, Mat V, int i) {
  const int b = chain->batch;
  PetscFunctionBeginUser;
  PetscCall(modal_dofs_sample(chain->at, chain->system, V, b, b, chain->sample[i]));
  PetscCall(modal_dofs_sample(chain->probe, chain->system, V, b, b, chain->probe_sample[i]));
  PetscFunctionReturn(0);
}

/* X = P K^-1 B */
static PetscErrorCode solve(const modal_residual_chain *chain, Mat X) {
  PetscFunctionBeginUser;
  PetscCall(modal_eigen_inverse(chain->eigen, chain->B, X));
  PetscCall(modal_eigen_project_out(chain->system, chain->eigen, X));
  PetscFunctionReturn(0);
}

/* product[batch][batch] = X^T Y */
static PetscErrorCode products(const modal_residual_chain *chain, Mat X, Mat Y, double *product) {
  const PetscScalar *x, *y;
  PetscInt           rows, lx, ly;
  const int          n = chain->batch;
  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(X, &rows, NULL));
  PetscCall(MatDenseGetLDA(X, &lx));
  PetscCall(MatDenseGetLDA(Y, &ly));
  PetscCall(MatDenseGetArrayRead(X, &x));
  PetscCall(MatDenseGetArrayRead(Y, &y));
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, n, n, (int)rows, 1, x, (int)lx, y, (int)ly,
              0, product, n);
  PetscCall(MatDenseRestoreArrayRead(Y, &y));
  PetscCall(MatDenseRestoreArrayRead(X, &x));
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, product, n * n, MPI_DOUBLE, MPI_SUM, chain->system->comm));
  PetscFunctionReturn(0);
}

/* V_i . M V_i and V_(i+1) . M V_i are the moments mu_(2i+2) and mu_(2i+3). B holds M V_i while X
 * becomes V_(i+1). */
PetscErrorCode modal_residual_chain_compute(modal_residual_chain *chain, const modal_dofs *column,
                                            int first, int count, int vectors) {
  Mat V = chain->X;
  PetscFunctionBeginUser;
  PetscCall(modal_dofs_spread(column, chain->system, first, count, chain->B));
  for (int i = 0; i < vectors; i++) {
    PetscCall(solve(chain, V));
    if (i < BLOCKS) PetscCall(sample(chain, V, i));
    if (i > 0) PetscCall(products(chain, V, chain->B, chain->moment[2 * i]));
    PetscCall(fem_mass_multiply(chain->system->M, V, chain->B));
    PetscCall(products(chain, V, chain->B, chain->moment[2 * i + 1]));
  }
  PetscFunctionReturn(0);
}

/* Rounding leaves a trace of the modes in V_0, which K^-1 M amplifies: it is removed twice. */
PetscErrorCode modal_residual_chain_compute_two(modal_residual_chain *chain,
                                                const modal_dofs *column, const bool *node,
                                                int first, int count) {
  PetscFunctionBeginUser;
  PetscCall(modal_dofs_spread(column, chain->system, first, count, chain->B));
  PetscCall(solve(chain, chain->X));
  PetscCall(modal_eigen_project_out(chain->system, chain->eigen, chain->X));
  PetscCall(sample(chain, chain->X, 0));
  PetscCall(fem_mass_multiply(chain->system->M, chain->X, chain->B));
  PetscCall(modal_eigen_inverse_at(chain->eigen, node, chain->B, chain->X));
  PetscCall(sample(chain, chain->X, 1));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_residual_chain_destroy(modal_residual_chain *chain) {
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&chain->B));
  PetscCall(MatDestroy(&chain->X));
  for (int i = 0; i < BLOCKS; i++) {
    PetscCall(PetscFree(chain->sample[i]));
    PetscCall(PetscFree(chain->probe_sample[i]));
  }
  for (int i = 0; i < MOMENTS; i++) PetscCall(PetscFree(chain->moment[i]));
  PetscFunctionReturn(0);
}
