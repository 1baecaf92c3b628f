#include "modal/condense/condense.h"

#include <math.h>
#include <string.h>

#include "fem/solver/petsc_error.h"
#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "modal/common/phases.h"
#include "modal/condense/few_columns.h"
#include "modal/condense/many_columns.h"

static void allocate(const modal_condensation *to, int n_modes, modal_model *model) {
  *model = (modal_model){.n_modes  = n_modes,
                         .n_pairs  = to->n_pairs,
                         .has_left = to->has_left,
                         .n_probes = to->probe.n / 3,
                         .n_load   = to->load.n_harmonics};
  modal_model_allocate(model, NULL, NULL);
}

static PetscErrorCode fill_shapes(const fem_system *system, const modal_eigen *eigen,
                                  const modal_condensation *to, modal_model *model) {
  const int m = eigen->n, nc = to->contact.n;
  double   *shape, *force;

  PetscFunctionBeginUser;
  const modal_load *load = &to->load;
  PetscCall(PetscMalloc2((size_t)nc * (size_t)m + 1, &shape, load->dofs.n * (size_t)m + 1, &force));
  PetscCall(modal_dofs_sample(&to->contact, system, eigen->phi, m, m, shape));
  PetscCall(modal_dofs_sample(&to->probe, system, eigen->phi, m, m, model->probe));
  PetscCall(modal_dofs_sample(&load->dofs, system, eigen->phi, m, m, force));
  size_t side = 3 * (size_t)to->n_pairs * (size_t)m;
  if (side > 0) memcpy(model->right, shape, side * sizeof(double));
  if (to->has_left) memcpy(model->left, shape + side, side * sizeof(double));
  for (int k = 0; k <= model->n_load; k++)
    for (int c = 0; c < load->dofs.n; c++)
      for (int i = 0; i < m; i++)
        model->modal_force[k * m + i] += load->weight[k * load->dofs.n + c] * force[c * m + i];
  for (int i = 0; i < m; i++) {
    model->frequency[i]      = sqrt(eigen->lambda[i]) / SHB_TWO_PI;
    model->eigen_residual[i] = eigen->eigen_residual[i];
  }
  PetscCall(PetscFree2(shape, force));
  PetscFunctionReturn(0);
}

static shb_status fill_modes(const fem_system *system, const modal_eigen *eigen,
                             const modal_condensation *to, modal_model *model) {
  FEM_PETSC(fill_shapes(system, eigen, to, model));
  for (int i = 0; i < eigen->n; i++)
    SHB_TRY(modal_damping_ratio(&to->damping, i, sqrt(eigen->lambda[i]), &model->damping_ratio[i]));
  return SHB_OK;
}

static shb_status fill_terms(const fem_system *system, const modal_eigen *eigen,
                             const modal_condensation *to, shb_progress *progress,
                             modal_model *model) {
  double left_out = 0;
  if (to->contact.n == 0) return SHB_OK;
  if (modal_columns_are_few(system, to)) {
    SHB_TRY(modal_few_columns_fill(system, eigen, to, model));
    modal_phase(system->comm, progress, "residuals", "%d contact dofs, %d residual modes",
                to->contact.n, model->n_residual);
    return SHB_OK;
  }
  SHB_TRY(modal_many_columns_fill(system, eigen, to, progress, model, &left_out));
  modal_phase(system->comm, progress, "residuals",
              "%d contact dofs, their omega^4 within %.1e of the flexibility", to->contact.n,
              left_out);
  return SHB_OK;
}

shb_status modal_condense(const fem_system *system, const modal_eigen *eigen,
                          const modal_condensation *to, shb_progress *progress,
                          modal_model *model) {
  allocate(to, eigen->n, model);
  SHB_TRY(fill_modes(system, eigen, to, model));
  return fill_terms(system, eigen, to, progress, model);
}
