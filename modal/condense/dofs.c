#include "modal/condense/dofs.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* Append one dof of n_entries entries, to be filled by the caller. */
static void append_dof(modal_dofs *dofs, int n_entries) {
  const size_t total     = (size_t)dofs->n_entries + (size_t)n_entries;
  dofs->start            = shb_realloc(dofs->start, (size_t)dofs->n + 2, sizeof *dofs->start);
  dofs->node             = shb_realloc(dofs->node, total, sizeof *dofs->node);
  dofs->weight           = shb_realloc(dofs->weight, 3 * total, sizeof *dofs->weight);
  dofs->start[dofs->n]   = dofs->n_entries;
  dofs->start[++dofs->n] = dofs->n_entries += n_entries;
}

void modal_dofs_add(modal_dofs *dofs, int n_entries, const int *node, const double *weight,
                    const double direction[3]) {
  const int first = dofs->n_entries;
  append_dof(dofs, n_entries);
  for (int e = 0; e < n_entries; e++) {
    dofs->node[first + e] = node[e];
    for (int d = 0; d < 3; d++) dofs->weight[3 * (first + e) + d] = weight[e] * direction[d];
  }
}

static int is_loaded(const double force[3]) {
  return force[0] != 0 || force[1] != 0 || force[2] != 0;
}

void modal_dofs_add_forces(modal_dofs *dofs, int n_nodes, const double *force) {
  int n_entries = 0, entry = dofs->n_entries;
  for (int i = 0; i < n_nodes; i++) n_entries += is_loaded(force + 3 * (size_t)i);
  append_dof(dofs, n_entries);
  for (int i = 0; i < n_nodes; i++) {
    if (!is_loaded(force + 3 * (size_t)i)) continue;
    dofs->node[entry] = i;
    memcpy(dofs->weight + 3 * (size_t)entry, force + 3 * (size_t)i, 3 * sizeof(double));
    entry++;
  }
}

void modal_dofs_append_one(modal_dofs *dofs, const modal_dofs *more, int c) {
  const int first = dofs->n_entries, from = more->start[c], n = more->start[c + 1] - from;
  append_dof(dofs, n);
  memcpy(dofs->node + first, more->node + from, (size_t)n * sizeof *dofs->node);
  memcpy(dofs->weight + 3 * (size_t)first, more->weight + 3 * (size_t)from,
         3 * (size_t)n * sizeof *dofs->weight);
}

void modal_dofs_append(modal_dofs *dofs, const modal_dofs *more) {
  for (int c = 0; c < more->n; c++) modal_dofs_append_one(dofs, more, c);
}

/* Local offset of a node's first dof in a dense column, -1 if clamped or another rank's. */
static PetscInt offset_of(const fem_system *system, int node) {
  PetscInt row = system->row[node];
  return row >= system->first && row < system->last ? 3 * (row - system->first) : -1;
}

PetscErrorCode modal_dofs_spread(const modal_dofs *dofs, const fem_system *system, int first,
                                 int count, Mat B) {
  PetscScalar *b;
  PetscInt     lda;

  PetscFunctionBeginUser;
  PetscCall(MatZeroEntries(B));
  PetscCall(MatDenseGetLDA(B, &lda));
  PetscCall(MatDenseGetArray(B, &b));
  for (int c = 0; c < count; c++)
    for (int e = dofs->start[first + c]; e < dofs->start[first + c + 1]; e++) {
      PetscInt offset = offset_of(system, dofs->node[e]);
      double   weight[3];
      if (offset < 0) continue;
      fem_system_to_row(system, dofs->node[e], dofs->weight + 3 * (size_t)e, weight);
      for (int d = 0; d < 3; d++) b[c * lda + offset + d] += weight[d];
    }
  PetscCall(MatDenseRestoreArray(B, &b));
  PetscFunctionReturn(0);
}

static double inner(const modal_dofs *dofs, const fem_system *system, int c, const PetscScalar *x) {
  double sum = 0;
  for (int e = dofs->start[c]; e < dofs->start[c + 1]; e++) {
    PetscInt offset = offset_of(system, dofs->node[e]);
    double   weight[3];
    if (offset < 0) continue;
    fem_system_to_row(system, dofs->node[e], dofs->weight + 3 * (size_t)e, weight);
    for (int d = 0; d < 3; d++) sum += weight[d] * x[offset + d];
  }
  return sum;
}

static PetscErrorCode sum_over_ranks(MPI_Comm comm, int n, double *value) {
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, value, n, MPI_DOUBLE, MPI_SUM, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_dofs_sample(const modal_dofs *dofs, const fem_system *system, Mat X,
                                 int n_columns, int stride, double *value) {
  const PetscScalar *x;
  PetscInt           lda;

  PetscFunctionBeginUser;
  PetscCall(MatDenseGetLDA(X, &lda));
  PetscCall(MatDenseGetArrayRead(X, &x));
  for (int c = 0; c < dofs->n; c++) {
    double *row = value + (size_t)c * (size_t)stride;
    for (int k = 0; k < n_columns; k++) row[k] = inner(dofs, system, c, x + k * lda);
    PetscCall(sum_over_ranks(system->comm, n_columns, row));
  }
  PetscCall(MatDenseRestoreArrayRead(X, &x));
  PetscFunctionReturn(0);
}

void modal_dofs_sample_nodal(const modal_dofs *dofs, const double *nodal, double *value) {
  for (int c = 0; c < dofs->n; c++) {
    value[c] = 0;
    for (int e = dofs->start[c]; e < dofs->start[c + 1]; e++)
      for (int d = 0; d < 3; d++)
        value[c] += dofs->weight[3 * (size_t)e + d] * nodal[3 * (size_t)dofs->node[e] + d];
  }
}

void modal_dofs_free(modal_dofs *dofs) {
  free(dofs->start);
  free(dofs->node);
  free(dofs->weight);
  memset(dofs, 0, sizeof *dofs);
}
