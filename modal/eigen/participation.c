#include "modal/eigen/participation.h"

#include <stdlib.h>
#include <string.h>

#include "fem/solver/petsc_error.h"
#include "mesh/base/memory.h"

static PetscErrorCode project(const fem_body *body, const double *displacement,
                              const fem_system *system, const modal_eigen *eigen,
                              modal_participation *out) {
  Vec load[FEM_RIGID], phi;
  PetscFunctionBeginUser;
  for (int r = 0; r < FEM_RIGID; r++) PetscCall(MatCreateVecs(system->M, NULL, &load[r]));
  PetscCall(fem_rigid_load(body, displacement, system, load, out->inertia));
  for (int i = 0; i < eigen->n; i++) {
    PetscCall(MatDenseGetColumnVecRead(eigen->phi, i, &phi));
    PetscCall(VecMDot(phi, FEM_RIGID, load, out->gamma + FEM_RIGID * (size_t)i));
    PetscCall(MatDenseRestoreColumnVecRead(eigen->phi, i, &phi));
  }
  for (int r = 0; r < FEM_RIGID; r++) PetscCall(VecDestroy(&load[r]));
  PetscFunctionReturn(0);
}

shb_status modal_participation_create(const fem_body *body, const double *displacement,
                                      const fem_system *system, const modal_eigen *eigen,
                                      modal_participation *out) {
  out->n_modes = eigen->n;
  out->gamma   = shb_alloc_zeroed((size_t)eigen->n, FEM_RIGID * sizeof *out->gamma);
  FEM_PETSC(project(body, displacement, system, eigen, out));
  return SHB_OK;
}

/* Write the columns first .. first + n - 1 of gamma, to the power 1 or 2, as a dataset. */
static shb_status write_columns(hid_t file, const modal_participation *p, const char *path,
                                int first, int n, int power, const char *const text[2]) {
  const size_t m    = (size_t)p->n_modes;
  double      *data = shb_alloc(m * (size_t)n, sizeof *data);
  for (size_t i = 0; i < m * (size_t)n; i++) {
    double gamma = p->gamma[FEM_RIGID * (i / (size_t)n) + (size_t)first + i % (size_t)n];
    data[i]      = power == 2 ? gamma * gamma : gamma;
  }
  h5_shape   shape  = n == 1 ? H5_SHAPE((hsize_t)m) : H5_SHAPE((hsize_t)m, (hsize_t)n);
  shb_status status = h5_write_double(file, path, shape, data, text[0], text[1]);
  if (status == SHB_OK) status = h5_attach_scale(file, path, 0, "/modes/frequency");
  free(data);
  return status;
}

shb_status modal_participation_write(hid_t file, const modal_participation *p) {
  static const struct {
    const char *path;
    int         first, n, power;
    const char *text[2];
  } table[] = {
      {"/modes/participation", 0, 3, 1, {"kg^1/2", "participation factors, translation x, y, z"}},
      {"/modes/effective_mass", 0, 3, 2, {"kg", "effective modal mass, translation x, y, z"}},
      {"/modes/rotation_participation",
       3,
       1,
       1,
       {"kg^1/2 m", "participation factor, rotation about the engine axis"}},
      {"/modes/effective_inertia",
       3,
       1,
       2,
       {"kg m^2", "effective modal moment of inertia about the engine axis"}},
  };
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    SHB_TRY(write_columns(file, p, table[i].path, table[i].first, table[i].n, table[i].power,
                          table[i].text));
  SHB_TRY(h5_write_attribute_double(file, "/", "mass", p->inertia[0]));
  return h5_write_attribute_double(file, "/", "inertia", p->inertia[3]);
}

void modal_participation_free(modal_participation *p) {
  free(p->gamma);
  memset(p, 0, sizeof *p);
}
