#include "modal/stage/speed_range.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/solver/petsc_error.h"

static int ascending(const void *a, const void *b) {
  double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

/* C[i][j] = phi_i^T M psi_j, phi: shapes of another speed. */
static PetscErrorCode project(Mat before, const modal_eigen *eigen, double *C) {
  Vec phi, m_psi;
  PetscFunctionBeginUser;
  for (int j = 0; j < eigen->n; j++) {
    PetscCall(MatDenseGetColumnVecRead(eigen->m_phi, j, &m_psi));
    for (int i = 0; i < eigen->n; i++) {
      PetscCall(MatDenseGetColumnVecRead(before, i, &phi));
      PetscCall(VecDot(phi, m_psi, &C[i * eigen->n + j]));
      PetscCall(MatDenseRestoreColumnVecRead(before, i, &phi));
    }
    PetscCall(MatDenseRestoreColumnVecRead(eigen->m_phi, j, &m_psi));
  }
  PetscFunctionReturn(0);
}

/* Match rows and columns by decreasing |C|, each once. next[i]: column of row i. */
static void match(int m, const double *C, int *next) {
  for (int i = 0; i < m; i++) next[i] = -1;
  for (int round = 0; round < m; round++) {
    int best[2] = {-1, -1};
    for (int j = 0; j < m; j++) {
      bool taken = false;
      for (int i = 0; i < m; i++) taken = taken || next[i] == j;
      for (int i = 0; i < m && !taken; i++)
        if (next[i] < 0 && (best[0] < 0 || fabs(C[i * m + j]) > fabs(C[best[0] * m + best[1]])))
          best[0] = i, best[1] = j;
    }
    next[best[0]] = best[1];
  }
}

static void negate(double *value, int rows, int m, int mode) {
  for (int r = 0; value && r < rows; r++) value[(size_t)r * (size_t)m + (size_t)mode] *= -1;
}

/* Change the sign of a mode in all its arrays. */
static PetscErrorCode change_sign(modal_result *r, int mode) {
  modal_model *model = &r->model;
  const int    m     = model->n_modes;
  Mat          all[] = {r->eigen.phi, r->eigen.m_phi};
  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    Vec column;
    PetscCall(MatDenseGetColumnVec(all[k], mode, &column));
    PetscCall(VecScale(column, -1));
    PetscCall(MatDenseRestoreColumnVec(all[k], mode, &column));
  }
  negate(model->right, 3 * model->n_pairs, m, mode);
  negate(model->left, 3 * model->n_pairs, m, mode);
  negate(model->probe, 3 * model->n_probes, m, mode);
  for (int k = 0; k <= model->n_load; k++) model->modal_force[k * m + mode] *= -1;
  for (int d = 0; d < FEM_RIGID; d++) r->participation.gamma[FEM_RIGID * mode + d] *= -1;
  PetscFunctionReturn(0);
}

/* Overlap of the modes with those of the first speed; first is NULL at the first speed itself. */
static PetscErrorCode store_overlap(Mat first, int s, const modal_result *r, modal_speeds *out) {
  const size_t m       = (size_t)out->n_modes;
  double      *overlap = out->overlap + (size_t)s * m * m;
  PetscFunctionBeginUser;
  for (size_t i = 0; !first && i < m; i++) overlap[i * (m + 1)] = 1;
  if (first) PetscCall(project(first, &r->eigen, overlap));
  PetscFunctionReturn(0);
}

/* Continue the tracks to speed s. before: mode shapes of speed s - 1; NULL at the first speed. */
static shb_status track(Mat before, int s, modal_result *r, modal_speeds *out) {
  const int m   = out->n_modes;
  int      *now = out->mode + (size_t)s * (size_t)m;
  double   *mac = out->mac + (size_t)s * (size_t)m;
  for (int t = 0; !before && t < m; t++) {
    now[t] = t;
    mac[t] = 1;
  }
  if (!before) return SHB_OK;
  double *C    = malloc((size_t)m * (size_t)m * sizeof *C);
  int    *next = malloc((size_t)m * sizeof *next);
  if (!C || !next) {
    free(C);
    free(next);
    SHB_FAIL(SHB_ERR_IO, "out of memory to track %d modes", m);
  }
  PetscErrorCode code = project(before, &r->eigen, C);
  if (code == 0) match(m, C, next);
  for (int t = 0; code == 0 && t < m; t++) {
    int    i = now[t - m], j = next[i]; /* track's mode at the speed before, at this one */
    double c = C[i * m + j];
    now[t]   = j;
    mac[t]   = PetscMin(1, c * c);
    if (c < 0) code = change_sign(r, j);
  }
  free(C);
  free(next);
  return fem_petsc_status(code);
}

static PetscErrorCode copy_shapes(const modal_result *r, Mat *before) {
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(before));
  PetscCall(MatDuplicate(r->eigen.phi, MAT_COPY_VALUES, before));
  PetscFunctionReturn(0);
}

/* Free the factor, the largest part of a result. */
static PetscErrorCode drop_factor(modal_result *r) {
  PetscFunctionBeginUser;
  PetscCall(EPSDestroy(&r->eigen.eps));
  PetscCall(fem_factor_destroy(&r->eigen.factor));
  PetscFunctionReturn(0);
}

/* Solve one speed. shapes: mode shapes of the first speed and of the speed before. */
static shb_status solve_speed(MPI_Comm comm, const mesh_fe *mesh, const modal_settings *settings,
                              int s, shb_progress *progress, modal_speeds *out, Mat shapes[2],
                              modal_result *result) {
  modal_settings settings_here = *settings;
  modal_result   now;
  settings_here.speed = out->speed[s];
  shb_progress_note(progress, "speed %d of %d: %.6g rad/s", s + 1, out->n, settings_here.speed);
  shb_status status = modal_solve(comm, mesh, &settings_here, progress, &now);
  if (status == SHB_OK) status = track(shapes[1], s, &now, out);
  if (status == SHB_OK) status = fem_petsc_status(store_overlap(shapes[0], s, &now, out));
  if (status == SHB_OK && s == 0) status = fem_petsc_status(copy_shapes(&now, &shapes[0]));
  if (status == SHB_OK) status = fem_petsc_status(copy_shapes(&now, &shapes[1]));
  if (status == SHB_OK) status = fem_petsc_status(drop_factor(&now));
  if (status == SHB_OK) out->model[s] = now.model; /* moved, or shared with result */
  if (status == SHB_OK && settings_here.speed == settings->speed) {
    *result = now;
    return SHB_OK;
  }
  if (status == SHB_OK) memset(&now.model, 0, sizeof now.model);
  modal_result_free(&now);
  return status;
}

/* With modal.modes: auto, the larger number needed at the lowest and the highest speed. */
static shb_status choose_modes(MPI_Comm comm, const mesh_fe *mesh, const modal_settings *settings,
                               shb_progress *progress, int *modes) {
  double range[2] = {INFINITY, 0};
  *modes          = settings->modes;
  for (int i = 0; i < settings->n_speeds; i++) {
    range[0] = fmin(range[0], settings->speeds[i]);
    range[1] = fmax(range[1], settings->speeds[i]);
  }
  for (int i = 0; i < 2 && settings->modes == 0; i++) {
    modal_settings settings_here = *settings;
    modal_result   result;
    settings_here.speed = range[i];
    shb_progress_note(progress, "modes needed at %.6g rad/s", settings_here.speed);
    shb_status status = modal_solve(comm, mesh, &settings_here, progress, &result);
    if (status == SHB_OK) *modes = PetscMax(*modes, result.model.n_modes);
    modal_result_free(&result);
    SHB_TRY(status);
  }
  return SHB_OK;
}

shb_status modal_speed_range_solve(MPI_Comm comm, const mesh_fe *mesh,
                                   const modal_settings *settings, shb_progress *progress,
                                   modal_speeds *speeds, modal_result *result) {
  Mat            shapes[2] = {NULL, NULL};
  modal_settings each      = *settings;
  memset(result, 0, sizeof *result);
  SHB_TRY(choose_modes(comm, mesh, settings, progress, &each.modes));
  SHB_TRY(modal_speeds_create(settings->n_speeds, each.modes, speeds));
  const size_t m  = (size_t)speeds->n_modes;
  speeds->overlap = calloc((size_t)speeds->n * m * m, sizeof *speeds->overlap);
  SHB_CHECK(speeds->overlap, SHB_ERR_IO, "out of memory to compare the modes of %d speeds",
            speeds->n);
  memcpy(speeds->speed, settings->speeds, (size_t)speeds->n * sizeof *speeds->speed);
  qsort(speeds->speed, (size_t)speeds->n, sizeof *speeds->speed, ascending);
  shb_status status = SHB_OK;
  for (int s = 0; status == SHB_OK && s < speeds->n; s++)
    status = solve_speed(comm, mesh, &each, s, progress, speeds, shapes, result);
  for (int i = 0; i < 2; i++) (void)MatDestroy(&shapes[i]);
  return status;
}

void modal_speed_range_free(modal_speeds *speeds, const modal_result *result) {
  for (int s = 0; speeds->model && s < speeds->n; s++)
    if (speeds->model[s].frequency && speeds->model[s].frequency == result->model.frequency)
      memset(&speeds->model[s], 0, sizeof speeds->model[s]);
  modal_speeds_free(speeds);
}
