#include "modal/condense/residual_shapes.h"

#include <stdlib.h>
#include <string.h>

#include "fem/solver/petsc_error.h"
#include "mesh/base/memory.h"

/* Columns and bytes in the file, 36 a node and column, at most. */
enum { MOST_COLUMNS = 96, MOST_BYTES = 256 << 20, BYTES = 36 };

static void allocate(const fem_system *system, const modal_load *load, int rank,
                     modal_residual_shapes *out) {
  const size_t patterns = (size_t)load->dofs.n, K = (size_t)load->n_harmonics + 1;
  out->load_weight = shb_alloc(K * patterns, sizeof *out->load_weight);
  out->shape =
      rank == 0 ? shb_alloc((size_t)out->n * 3 * (size_t)system->n_nodes, sizeof(double)) : NULL;
  memcpy(out->load_weight, load->weight, K * patterns * sizeof *out->load_weight);
}

static PetscErrorCode fill(const fem_system *system, const modal_eigen *eigen,
                           const modal_dofs *column, int rank, double *shape) {
  const size_t stride = 3 * (size_t)system->n_nodes;
  Mat          B, X;
  PetscFunctionBeginUser;
  PetscCall(modal_dense_create(system, column->n, &B));
  PetscCall(modal_dense_create(system, column->n, &X));
  PetscCall(modal_dofs_spread(column, system, 0, column->n, B));
  PetscCall(modal_eigen_inverse(eigen, B, X));
  PetscCall(modal_eigen_project_out(system, eigen, X));
  for (int c = 0; c < column->n; c++) {
    Vec x;
    PetscCall(MatDenseGetColumnVecRead(X, c, &x));
    PetscCall(fem_system_gather(system, x, rank == 0 ? shape + (size_t)c * stride : NULL));
    PetscCall(MatDenseRestoreColumnVecRead(X, c, &x));
  }
  PetscCall(MatDestroy(&B));
  PetscCall(MatDestroy(&X));
  PetscFunctionReturn(0);
}

shb_status modal_residual_shapes_create(const fem_system *system, const modal_eigen *eigen,
                                        const modal_condensation *to, modal_residual_shapes *out) {
  const int  n      = to->contact.n + to->load.dofs.n;
  modal_dofs column = {0};
  int        rank;
  memset(out, 0, sizeof *out);
  if (n == 0 || n > MOST_COLUMNS || (double)n * system->n_nodes * BYTES > MOST_BYTES) return SHB_OK;
  MPI_Comm_rank(system->comm, &rank);
  out->n           = n;
  out->n_contact   = to->contact.n;
  out->n_nodes     = system->n_nodes;
  out->n_harmonics = to->load.n_harmonics;
  allocate(system, &to->load, rank, out);
  modal_dofs_append(&column, &to->contact);
  modal_dofs_append(&column, &to->load.dofs);
  const shb_status status = fem_petsc_status(fill(system, eigen, &column, rank, out->shape));
  modal_dofs_free(&column);
  return status;
}

/* shape is written in single precision, as the stress. */
static shb_status write_shape(hid_t file, const modal_residual_shapes *s) {
  const size_t count  = (size_t)s->n * 3 * (size_t)s->n_nodes;
  float       *single = shb_alloc(count, sizeof *single);
  for (size_t i = 0; i < count; i++) single[i] = (float)s->shape[i];
  shb_status status = h5_write_single(
      file, "residual/shape", H5_SHAPE((hsize_t)s->n, (hsize_t)s->n_nodes, 3), single, "m/N",
      "static displacement by a unit force on each contact dof, then by each load "
      "pattern, modes removed, mesh axes (x, y, z)");
  free(single);
  return status;
}

shb_status modal_residual_weight_write(hid_t file, const modal_residual_shapes *s) {
  return h5_write_complex(file, "residual/load_weight",
                          H5_SHAPE((hsize_t)s->n_harmonics + 1, (hsize_t)(s->n - s->n_contact)),
                          s->load_weight, "-",
                          "share of each load pattern in each harmonic of the load");
}

shb_status modal_residual_shapes_write(hid_t file, const modal_residual_shapes *s,
                                       const float *stress) {
  if (s->n == 0) return SHB_OK;
  SHB_TRY(write_shape(file, s));
  SHB_TRY(h5_write_single(file, "residual/stress", H5_SHAPE((hsize_t)s->n, (hsize_t)s->n_nodes, 6),
                          stress, "Pa/N",
                          "Cauchy stress of the same: xx, yy, zz, xy, yz, xz in mesh axes"));
  return modal_residual_weight_write(file, s);
}

void modal_residual_shapes_free(modal_residual_shapes *s) {
  free(s->shape);
  free(s->load_weight);
  memset(s, 0, sizeof *s);
}
