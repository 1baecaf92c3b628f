#include "modal/condense.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/fault.h"
#include "modal/phases.h"

enum { BATCH = 32 }; /* right-hand sides a solve: beyond this MUMPS gains nothing, memory grows */

static const double two_pi = 6.28318530717958647692;

/* Matrices of one batch, and where its columns go. */
typedef struct {
  int                       batch; /* columns */
  const fem_system         *system;
  const modal_eigen        *eigen;
  const modal_condensation *to;
  Mat                       B, X, Y;         /* [3 n_free][batch] */
  double                   *contact, *probe; /* [dof][batch] samples of X */
} workspace;

static shb_status allocate(const modal_condensation *to, int n_modes, modal_model *model) {
  const size_t m = (size_t)n_modes, pairs = (size_t)to->n_pairs, nc = (size_t)to->contact.n;
  const size_t q3 = (size_t)to->probe.n, k = (size_t)to->load.n_harmonics + 1;
  model->n_modes                = n_modes;
  model->n_pairs                = to->n_pairs;
  model->has_left               = to->has_left;
  model->n_probes               = to->probe.n / 3;
  model->n_load                 = to->load.n_harmonics;
  model->frequency              = calloc(m, sizeof(double));
  model->damping_ratio          = calloc(m, sizeof(double));
  model->mode_residual          = calloc(m, sizeof(double));
  model->right                  = calloc(3 * pairs * m, sizeof(double));
  model->left                   = to->has_left ? calloc(3 * pairs * m, sizeof(double)) : NULL;
  model->residual_flexibility   = calloc(nc * nc, sizeof(double));
  model->residual_inertia       = calloc(nc * nc, sizeof(double));
  model->residual_fourth        = calloc(nc * nc, sizeof(double));
  model->moment_fourth          = calloc(nc, sizeof(double));
  model->moment_fifth           = calloc(nc, sizeof(double));
  model->modal_force            = calloc(k * m, sizeof(double complex));
  model->load_residual          = calloc(k * nc, sizeof(double complex));
  model->probe                  = calloc(q3 * m + 1, sizeof(double));
  model->probe_contact_residual = calloc(q3 * nc + 1, sizeof(double));
  model->probe_load_residual    = calloc(k * q3 + 1, sizeof(double complex));
  model->load_inertia           = calloc(k * nc, sizeof(double complex));
  model->probe_contact_inertia  = calloc(q3 * nc + 1, sizeof(double));
  model->probe_load_inertia     = calloc(k * q3 + 1, sizeof(double complex));
  SHB_CHECK(model->frequency && model->damping_ratio && model->mode_residual && model->right &&
                (model->left || !to->has_left) && model->residual_flexibility &&
                model->residual_inertia && model->residual_fourth && model->moment_fourth &&
                model->moment_fifth && model->modal_force && model->load_residual && model->probe &&
                model->probe_contact_residual && model->probe_load_residual &&
                model->load_inertia && model->probe_contact_inertia && model->probe_load_inertia,
            SHB_ERR_IO, "out of memory for a modal model of %zu contact dofs", nc);
  return SHB_OK;
}

static PetscErrorCode fill_shapes(const workspace *w, modal_model *model) {
  const modal_condensation *to = w->to;
  const int                 m = w->eigen->n, nc = to->contact.n;
  double                   *shape, *force;

  PetscFunctionBeginUser;
  const modal_load *load = &to->load;
  PetscCall(PetscMalloc2((size_t)nc * (size_t)m, &shape, load->dofs.n * (size_t)m, &force));
  PetscCall(modal_dofs_sample(&to->contact, w->system, w->eigen->phi, m, m, shape));
  PetscCall(modal_dofs_sample(&to->probe, w->system, w->eigen->phi, m, m, model->probe));
  PetscCall(modal_dofs_sample(&load->dofs, w->system, w->eigen->phi, m, m, force));
  size_t side = 3 * (size_t)to->n_pairs * (size_t)m;
  memcpy(model->right, shape, side * sizeof(double));
  if (to->has_left) memcpy(model->left, shape + side, side * sizeof(double));
  for (int k = 0; k <= model->n_load; k++)
    for (int c = 0; c < load->dofs.n; c++)
      for (int i = 0; i < m; i++)
        model->modal_force[k * m + i] += load->weight[k * load->dofs.n + c] * force[c * m + i];
  for (int i = 0; i < m; i++) {
    model->frequency[i]     = sqrt(w->eigen->lambda[i]) / two_pi;
    model->mode_residual[i] = w->eigen->residual[i];
  }
  PetscCall(PetscFree2(shape, force));
  PetscFunctionReturn(0);
}

/* X = P K^-1 B, sampled at contact and probe dofs. */
static PetscErrorCode solve_batch(workspace *w, Mat X) {
  PetscFunctionBeginUser;
  PetscCall(modal_eigen_inverse(w->eigen, w->B, X));
  PetscCall(modal_eigen_remove(w->system, w->eigen, X));
  PetscCall(modal_dofs_sample(&w->to->contact, w->system, X, w->batch, w->batch, w->contact));
  PetscCall(modal_dofs_sample(&w->to->probe, w->system, X, w->batch, w->batch, w->probe));
  PetscFunctionReturn(0);
}

/* The next term of the series, sampled: Y = P K^-1 M X. */
static PetscErrorCode solve_next(workspace *w, Mat X, Mat Y) {
  PetscFunctionBeginUser;
  PetscCall(modal_mass_multiply(w->system, X, w->B));
  PetscCall(solve_batch(w, Y));
  PetscFunctionReturn(0);
}

/* Columns first..first + count - 1 of to [rows][columns] from the samples [rows][batch]. */
static void put_columns(const workspace *w, const double *sample, int rows, int first, int count,
                        double *to) {
  const size_t columns = (size_t)w->to->contact.n, batch = (size_t)w->batch;
  for (size_t r = 0; r < (size_t)rows; r++)
    for (int c = 0; c < count; c++)
      to[r * columns + (size_t)(first + c)] = sample[r * batch + (size_t)c];
}

/* moment[first + c] = X_c . Y_c */
static PetscErrorCode column_products(Mat X, Mat Y, int first, int count, double *moment) {
  Vec x, y;
  PetscFunctionBeginUser;
  for (int c = 0; c < count; c++) {
    PetscCall(MatDenseGetColumnVecRead(X, c, &x));
    PetscCall(MatDenseGetColumnVecRead(Y, c, &y));
    PetscCall(VecDot(x, y, &moment[first + c]));
    PetscCall(MatDenseRestoreColumnVecRead(Y, c, &y));
    PetscCall(MatDenseRestoreColumnVecRead(X, c, &x));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode contact_batch(workspace *w, int first, int count, modal_model *model) {
  const int nc = w->to->contact.n, q3 = w->to->probe.n;
  PetscFunctionBeginUser;
  PetscCall(modal_dofs_spread(&w->to->contact, w->system, first, count, w->B));
  PetscCall(solve_batch(w, w->X));
  put_columns(w, w->contact, nc, first, count, model->residual_flexibility);
  put_columns(w, w->probe, q3, first, count, model->probe_contact_residual);
  PetscCall(solve_next(w, w->X, w->Y));
  put_columns(w, w->contact, nc, first, count, model->residual_inertia);
  put_columns(w, w->probe, q3, first, count, model->probe_contact_inertia);
  PetscCall(solve_next(w, w->Y, w->X));
  put_columns(w, w->contact, nc, first, count, model->residual_fourth);
  PetscCall(column_products(w->Y, w->B, first, count, model->moment_fourth)); /* B = M Y */
  PetscCall(column_products(w->X, w->B, first, count, model->moment_fifth));
  PetscFunctionReturn(0);
}

/* Add the samples of one pattern, times what each harmonic takes of it. */
static void add_load(const workspace *w, int pattern, double complex *contact,
                     double complex *probe) {
  const modal_load *load = &w->to->load;
  const int         nc = w->to->contact.n, q3 = w->to->probe.n;
  for (int k = 0; k <= load->n_harmonics; k++) {
    double complex weight = load->weight[k * load->dofs.n + pattern];
    for (int c = 0; c < nc; c++) contact[k * nc + c] += weight * w->contact[c];
    for (int c = 0; c < q3; c++) probe[k * q3 + c] += weight * w->probe[c];
  }
}

static PetscErrorCode load_batch(workspace *w, int pattern, modal_model *model) {
  PetscFunctionBeginUser;
  PetscCall(modal_dofs_spread(&w->to->load.dofs, w->system, pattern, 1, w->B));
  PetscCall(solve_batch(w, w->X));
  add_load(w, pattern, model->load_residual, model->probe_load_residual);
  PetscCall(solve_next(w, w->X, w->Y));
  add_load(w, pattern, model->load_inertia, model->probe_load_inertia);
  PetscFunctionReturn(0);
}

/* Equal up to rounding; the balance relies on it. */
static void symmetrise(double *a, size_t n) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++) a[i * n + j] = a[j * n + i] = (a[i * n + j] + a[j * n + i]) / 2;
}

static PetscErrorCode create_workspace(workspace *w, int batch) {
  PetscFunctionBeginUser;
  w->batch = batch;
  PetscCall(modal_dense_create(w->system, batch, &w->B));
  PetscCall(modal_dense_create(w->system, batch, &w->X));
  PetscCall(modal_dense_create(w->system, batch, &w->Y));
  PetscCall(PetscMalloc2((size_t)w->to->contact.n * (size_t)batch, &w->contact,
                         (size_t)w->to->probe.n * (size_t)batch, &w->probe));
  PetscFunctionReturn(0);
}

static PetscErrorCode destroy_workspace(workspace *w) {
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&w->B));
  PetscCall(MatDestroy(&w->X));
  PetscCall(MatDestroy(&w->Y));
  PetscCall(PetscFree2(w->contact, w->probe));
  PetscFunctionReturn(0);
}

static shb_status fill(workspace *w, shb_progress *progress, modal_model *model) {
  const int nc = w->to->contact.n, batch = nc < BATCH ? nc : BATCH;
  FEM_PETSC(create_workspace(w, batch));
  FEM_PETSC(fill_shapes(w, model));
  for (int i = 0; i < w->eigen->n; i++)
    SHB_TRY(modal_damping_ratio(&w->to->damping, i, sqrt(w->eigen->lambda[i]),
                                &model->damping_ratio[i]));
  for (int first = 0; first < nc; first += batch) {
    int count = nc - first < batch ? nc - first : batch, stop = shb_interrupted();
    MPI_Allreduce(MPI_IN_PLACE, &stop, 1, MPI_INT, MPI_MAX, w->system->comm);
    SHB_CHECK(!stop, SHB_INTERRUPTED, "interrupted");
    shb_progress_show(progress, 80 + 15. * first / nc, "residuals: contact dof %d of %d", first,
                      nc);
    FEM_PETSC(contact_batch(w, first, count, model));
  }
  FEM_PETSC(destroy_workspace(w));
  FEM_PETSC(create_workspace(w, 1));
  for (int c = 0; c < w->to->load.dofs.n; c++) FEM_PETSC(load_batch(w, c, model));
  symmetrise(model->residual_flexibility, (size_t)nc);
  symmetrise(model->residual_inertia, (size_t)nc);
  symmetrise(model->residual_fourth, (size_t)nc);
  return SHB_OK;
}

shb_status modal_condense(const fem_system *system, const modal_eigen *eigen,
                          const modal_condensation *to, shb_progress *progress,
                          modal_model *model) {
  workspace w = {.system = system, .eigen = eigen, .to = to};
  memset(model, 0, sizeof *model);
  SHB_TRY(allocate(to, eigen->n, model));
  shb_status status = fill(&w, progress, model);
  FEM_PETSC(destroy_workspace(&w));
  if (status == SHB_OK)
    modal_phase(system->comm, progress, "residuals", "%d contact dofs", to->contact.n);
  return status;
}
