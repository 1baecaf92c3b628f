#include "modal/stage/speed_range.h"
#include "mesh/base/memory.h"
#include "modal/stage/sector_modes.h"

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
  negate(model->coriolis, m, m, mode);
  for (int j = 0; model->coriolis && j < m; j++) model->coriolis[mode * m + j] *= -1;
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
  const int m = out->n_modes;
  if (!before) {
    modal_tracks_continue(NULL, s, NULL, out);
    return SHB_OK;
  }
  double        *C       = shb_alloc(2 * (size_t)m * (size_t)m, sizeof *C);
  int           *next    = shb_alloc((size_t)m, sizeof *next);
  double        *overlap = C + m * m;
  PetscErrorCode code    = project(before, &r->eigen, C);
  for (int i = 0; i < m * m && code == 0; i++) overlap[i] = fabs(C[i]);
  if (code == 0) modal_tracks_continue(overlap, s, next, out);
  for (int i = 0; i < m && code == 0; i++)
    if (C[i * m + next[i]] < 0) code = change_sign(r, next[i]);
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

/* All that the speeds of a range share. */
typedef struct {
  MPI_Comm            comm;
  const mesh_fe      *mesh;
  modal_settings      settings;
  shb_progress       *progress;
  modal_speeds       *out;
  Mat                 shapes[2]; /* mode shapes of the first speed and of the speed before */
  modal_sector       *sector;    /* NULL: a clamped blade */
  modal_sector_tracks tracks;    /* of the sector */
} speed_work;

/* The other nodal diameters of a sector at one speed. */
static shb_status solve_sector(speed_work *r, const modal_settings *here, int s,
                               modal_result *now) {
  modal_sector_speeds *speeds = &r->sector->speeds;
  modal_sector         found;
  r->tracks.s       = s;
  r->tracks.main    = here->speed == r->settings.speed;
  shb_status status = modal_sector_solve(r->mesh, here, r->progress, now, &r->tracks, &found);
  for (int i = 1; status == SHB_OK && i < speeds->n; i++) {
    modal_speeds *at = &speeds->at[i];
    at->model[s]     = found.models.model[i]; /* moved, or shared with the sector */
    if (!at->imaginary) continue;
    at->imaginary[s] = found.models.imaginary[i];
    at->backward[s]  = found.models.backward[i];
  }
  if (status == SHB_OK && r->tracks.main) {
    found.speeds = *speeds;
    *r->sector   = found;
    return SHB_OK;
  }
  for (int i = 1; status == SHB_OK && i < speeds->n; i++)
    found.models.model[i] = found.models.imaginary[i] = found.models.backward[i] = (modal_model){0};
  modal_sector_free(&found, now);
  return status;
}

/* Solve one speed. */
static shb_status solve_speed(speed_work *r, int s, modal_result *result) {
  modal_settings here = r->settings;
  modal_speeds  *out  = r->out;
  modal_result   now;
  here.speed = out->speed[s];
  shb_progress_note(r->progress, "speed %d of %d: %.6g rad/s", s + 1, out->n, here.speed);
  shb_status status = modal_solve(r->comm, r->mesh, &here, r->progress, &now);
  if (status == SHB_OK) status = track(r->shapes[1], s, &now, out);
  if (status == SHB_OK) status = fem_petsc_status(store_overlap(r->shapes[0], s, &now, out));
  if (status == SHB_OK && s == 0) status = fem_petsc_status(copy_shapes(&now, &r->shapes[0]));
  if (status == SHB_OK) status = fem_petsc_status(copy_shapes(&now, &r->shapes[1]));
  if (status == SHB_OK) status = fem_petsc_status(modal_eigen_drop_factor(&now.eigen));
  if (status == SHB_OK && r->sector) status = solve_sector(r, &here, s, &now);
  if (status == SHB_OK) out->model[s] = now.model; /* moved, or shared with result */
  if (status == SHB_OK && here.speed == r->settings.speed) {
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
    modal_sector   sector = {0};
    settings_here.speed   = range[i];
    shb_progress_note(progress, "modes needed at %.6g rad/s", settings_here.speed);
    shb_status status = mesh->image ? modal_sector_solve_enough(comm, mesh, &settings_here,
                                                                progress, &result, &sector)
                                    : modal_solve(comm, mesh, &settings_here, progress, &result);
    if (status == SHB_OK) *modes = PetscMax(*modes, result.model.n_modes);
    modal_sector_free(&sector, &result);
    modal_result_free(&result);
    SHB_TRY(status);
  }
  return SHB_OK;
}

/* The tracks of all nodal diameters of a sector. */
static void begin_sector(speed_work *r) {
  modal_nodal_diameters models;
  modal_sector_list(&r->settings, &models);
  modal_sector_tracks_create(&models, r->out->n, r->out->speed, r->out->n_modes, &r->sector->speeds,
                             &r->tracks);
  modal_nodal_diameters_free(&models);
}

static shb_status solve_all(speed_work *r, modal_result *result) {
  shb_status status = SHB_OK;
  if (r->sector) begin_sector(r);
  for (int s = 0; status == SHB_OK && s < r->out->n; s++) status = solve_speed(r, s, result);
  if (status == SHB_OK && r->sector) {
    r->sector->speeds.at[0] = *r->out;
    *r->out                 = (modal_speeds){0};
  }
  if (r->sector) modal_sector_tracks_free(&r->tracks);
  for (int i = 0; i < 2; i++) (void)MatDestroy(&r->shapes[i]);
  return status;
}

shb_status modal_speed_range_solve(MPI_Comm comm, const mesh_fe *mesh,
                                   const modal_settings *settings, shb_progress *progress,
                                   modal_speeds *speeds, modal_sector *sector,
                                   modal_result *result) {
  speed_work r = {.comm     = comm,
                  .mesh     = mesh,
                  .settings = *settings,
                  .progress = progress,
                  .out      = speeds,
                  .sector   = sector};
  memset(result, 0, sizeof *result);
  SHB_TRY(choose_modes(comm, mesh, settings, progress, &r.settings.modes));
  modal_speeds_create(settings->n_speeds, r.settings.modes, speeds);
  const size_t m  = (size_t)speeds->n_modes;
  speeds->overlap = shb_alloc_zeroed((size_t)speeds->n * m * m, sizeof *speeds->overlap);
  memcpy(speeds->speed, settings->speeds, (size_t)speeds->n * sizeof *speeds->speed);
  qsort(speeds->speed, (size_t)speeds->n, sizeof *speeds->speed, ascending);
  return solve_all(&r, result);
}

void modal_speed_range_free(modal_speeds *speeds, const modal_result *result) {
  for (int s = 0; speeds->model && s < speeds->n; s++)
    if (speeds->model[s].frequency && speeds->model[s].frequency == result->model.frequency)
      memset(&speeds->model[s], 0, sizeof speeds->model[s]);
  modal_speeds_free(speeds);
}
