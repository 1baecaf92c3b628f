/* Block Krylov vectors of the residual terms for a batch of columns B, V_0 = P K^-1 B and
 * V_(i+1) = P K^-1 M V_i. They are sampled at dofs. Their moments are those of
 * modal/condense/residual_modes.h. */
#ifndef MODAL_CONDENSE_RESIDUAL_CHAIN_H
#define MODAL_CONDENSE_RESIDUAL_CHAIN_H

#include "modal/condense/dofs.h"
#include "modal/condense/residual_modes.h"
#include "modal/eigen/eigen.h"

typedef struct {
  const fem_system  *system;
  const modal_eigen *eigen;
  const modal_dofs  *at, *probe;                            /* where the vectors are sampled */
  int                batch;                                 /* columns */
  Mat                B, X;                                  /* [3 n_free][batch] */
  double            *sample[MODAL_RESIDUAL_BLOCKS];         /* [at][batch] V_0, V_1, V_2 */
  double            *probe_sample[MODAL_RESIDUAL_BLOCKS];   /* [probe][batch] the same */
  double            *moment[2 * MODAL_RESIDUAL_BLOCKS + 2]; /* [batch][batch] mu_1 .. mu_8 */
} modal_residual_chain;

PetscErrorCode modal_residual_chain_create(const fem_system *system, const modal_eigen *eigen,
                                           const modal_dofs *at, const modal_dofs *probe, int batch,
                                           modal_residual_chain *chain);

/* Vectors V_0 .. V_(vectors - 1) of dofs first .. first + count - 1 as columns. They give the
 * moments mu_2 .. mu_(2 vectors). Collective.
 *   vectors  in  MODAL_RESIDUAL_BLOCKS, or one more, which is not sampled */
PetscErrorCode modal_residual_chain_compute(modal_residual_chain *chain, const modal_dofs *column,
                                            int first, int count, int vectors);

/* The first two samples, V_0 and V_1, alone. V_1 is solved at the sampled dofs only. Collective.
 *   node  in  [free nodes of this rank] true: has a sampled dof */
PetscErrorCode modal_residual_chain_compute_two(modal_residual_chain *chain,
                                                const modal_dofs *column, const bool *node,
                                                int first, int count);

PetscErrorCode modal_residual_chain_destroy(modal_residual_chain *chain); /* also of a zeroed one */

#endif
