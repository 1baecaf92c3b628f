#include "modal/stage/sector_solve.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fem/body/sector.h"
#include "fem/solver/hermitian.h"
#include "fem/solver/petsc_error.h"
#include "mesh/base/memory.h"
#include "modal/common/phases.h"
#include "modal/cyclic/wave_condense.h"
#include "modal/cyclic/wave_coriolis.h"
#include "modal/cyclic/wave_modes.h"

enum { MESSAGE = 512 };

/* What all threads share, and what each nodal diameter leaves. */
typedef struct {
  const fem_body       *body;
  const double         *state; /* static displacement, NULL at rest */
  const modal_settings *settings;
  const modal_result   *first;
  fem_sector            matrices;
  fem_hermitian_order  *order;
  modal_sector_tracks  *tracks; /* NULL: one speed */
  modal_sector         *out;
  shb_status           *status; /* [n] */
  char (*message)[MESSAGE];     /* [n] */
} work;

shb_status modal_sector_check(MPI_Comm comm, const modal_settings *settings) {
  int ranks;
  MPI_Comm_size(comm, &ranks);
  SHB_CHECK(ranks == 1, SHB_ERR_INPUT,
            "a sector with cyclic sides runs as one process; its %d ranks are distributed (several "
            "machines, MUMPS, OMP_PROC_BIND or more than a million nodes)",
            ranks);
  SHB_CHECK(settings->check != MODAL_CHECK_INERTIA, SHB_ERR_INPUT,
            "modal.check: inertia is for a clamped blade; leave it at auto, or give never");
  for (int i = 0; i < settings->n_diameters; i++)
    SHB_CHECK(2 * settings->diameter[i] <= settings->blades, SHB_ERR_INPUT,
              "modal.nodal_diameters: %d is above N/2 = %g of %d blades; nodal diameter n above "
              "N/2 is the backward wave of N - n",
              settings->diameter[i], settings->blades / 2., settings->blades);
  return SHB_OK;
}

void modal_sector_list(const modal_settings *settings, modal_nodal_diameters *out) {
  const int most = settings->blades / 2;
  int      *list = shb_alloc((size_t)most + 1, sizeof *list), n = 0;
  for (int d = 0; d <= most; d++) {
    bool wanted = d == 0 || settings->n_diameters < 0;
    for (int i = 0; i < settings->n_diameters; i++) wanted = wanted || settings->diameter[i] == d;
    if (wanted) list[n++] = d;
  }
  modal_nodal_diameters_create(settings->blades, n, out);
  memcpy(out->diameter, list, (size_t)n * sizeof *list);
  free(list);
}

/* Residual columns are kept as long as those of all nodal diameters take less than this in the
 * file. */
static const double MOST_COLUMN_BYTES = 512 << 20;

/* Whether nodal diameter 0 has columns, and all of them fit into the file. */
static bool has_columns(const modal_result *first, int n) {
  const double each = 9. * sizeof(float complex) * first->residual.n * first->residual.n_nodes;
  return first->residual.n > 0 && n * each <= MOST_COLUMN_BYTES;
}

/* Of several speeds one is shown at every node. */
static bool wants_fields(const work *w) {
  return !w->tracks || w->tracks->main;
}

/* The Coriolis matrix of the modes of a nodal diameter, where it is asked for. */
static void add_coriolis(const work *w, const wave_modes *modes, modal_model *re, modal_model *im) {
  const size_t square  = (size_t)modes->n * (size_t)modes->n;
  const bool   is_real = !im->probe; /* allocated for every complex model */
  if (w->settings->coriolis == FEM_TURNS_UNSAID) return;
  re->coriolis = shb_alloc_zeroed(square, sizeof *re->coriolis);
  if (!is_real) im->coriolis = shb_alloc_zeroed(square, sizeof *im->coriolis);
  wave_coriolis(modes, &w->body->rotation, w->settings->coriolis, re->coriolis, im->coriolis);
}

/* Modes and condensation with a factor. */
static shb_status solve_with(const work *w, int i, wave_operator *op, wave_modes *modes) {
  const wave_settings    wanted = {.modes = w->settings->modes, .check = w->settings->check};
  modal_nodal_diameters *all    = &w->out->models;
  SHB_TRY(wave_modes_solve(op, &wanted, w->body, w->state, modes));
  w->out->check[i] = modes->check;
  if (wants_fields(w))
    wave_fields_create(op, modes, &w->first->to, w->body, w->state, has_columns(w->first, all->n),
                       &w->out->fields[i]);
  SHB_TRY(wave_condense(op, modes, &w->first->to, &all->model[i], &all->imaginary[i],
                        &all->backward[i]));
  add_coriolis(w, modes, &all->model[i], &all->imaginary[i]);
  if (w->tracks) modal_sector_tracks_take(w->tracks, i, modes); /* takes the shapes */
  modal_label(w->settings, &w->first->patches, &all->model[i]);
  return SHB_OK;
}

static shb_status solve_one(const work *w, int i) {
  wave_operator op     = {0};
  wave_modes    modes  = {0};
  shb_status    status = wave_operator_create(&w->matrices, w->order, w->out->models.diameter[i],
                                              w->settings->blades, &op);
  if (status == SHB_OK) status = solve_with(w, i, &op, &modes);
  wave_modes_free(&modes);
  wave_operator_free(&op);
  return status;
}

/* Bytes of one nodal diameter: factor, Lanczos basis, modes, vectors of the condensation. */
static double bytes_each(const work *w) {
  const double order = 3. * w->matrices.n_rows, modes = w->settings->modes;
  return fem_hermitian_bytes(w->order) + 16 * order * (5 * modes + 40 + 4 * 30);
}

/* Bytes of all nodal diameters that stay: fields until the file is written, shapes of two speeds
 * that tracks are continued from. */
static double bytes_kept(const work *w) {
  const double nodes = w->body->mesh->n_nodes, modes = w->settings->modes;
  const double fields = modes * (3. * sizeof(double complex) + 6. * sizeof(float complex)) +
                        w->first->residual.n * 9. * sizeof(float complex);
  const double shapes = 2 * 3. * sizeof(double complex) * modes;
  return w->out->models.n * nodes * (fields + (w->tracks ? shapes : 0));
}

/* Threads that the memory allows; SHB_ERR_INPUT: not even one. */
static shb_status count_threads(const work *w, int *threads) {
  const double each = bytes_each(w), left = shb_memory_available() - bytes_kept(w);
  *threads = omp_get_max_threads();
  SHB_CHECK(each <= left, SHB_ERR_INPUT,
            "a nodal diameter of this mesh (%d free nodes) needs %.3g GB more memory, and %.3g GB "
            "are left; make a coarser mesh",
            w->matrices.n_rows, 1e-9 * each, 1e-9 * left);
  if (left < each * *threads) *threads = (int)(left / each);
  return SHB_OK;
}

/* All nodal diameters but the first. Error texts belong to their thread and are kept. */
static void solve_all(work *w, int threads) {
  const int n = w->out->models.n, levels = omp_get_max_active_levels();
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (int i = 1; i < n; i++) {
    if (shb_interrupted()) {
      w->status[i] = SHB_INTERRUPTED;
      snprintf(w->message[i], MESSAGE, "interrupted");
      continue;
    }
    w->status[i] = solve_one(w, i);
    if (w->status[i] != SHB_OK) snprintf(w->message[i], MESSAGE, "%s", shb_message());
  }
  omp_set_max_active_levels(levels);
}

/* The first failure, with its nodal diameter. */
static shb_status report(const work *w) {
  for (int i = 1; i < w->out->models.n; i++)
    if (w->status[i] != SHB_OK)
      return shb_fail(w->status[i], __FILE__, __LINE__, "nodal diameter %d: %s",
                      w->out->models.diameter[i], w->message[i]);
  return SHB_OK;
}

static void note(const work *w, shb_progress *progress) {
  for (int i = 0; i < w->out->models.n; i++)
    shb_progress_note(progress,
                      "nodal diameter %d: %d modes, %.6g to %.6g Hz, none missing below %.6g Hz "
                      "by %s",
                      w->out->models.diameter[i], w->out->models.model[i].n_modes,
                      w->out->models.model[i].frequency[0],
                      w->out->models.model[i].frequency[w->settings->modes - 1],
                      modal_check_frequency(&w->out->check[i]), w->out->check[i].method);
}

static void allocate(modal_sector *out, work *w) {
  const size_t n = (size_t)out->models.n;
  out->check     = shb_alloc_zeroed(n, sizeof *out->check);
  out->fields    = shb_alloc_zeroed(n, sizeof *out->fields);
  w->status      = shb_alloc_zeroed(n, sizeof *w->status);
  w->message     = shb_alloc_zeroed(n, sizeof *w->message);
}

static shb_status solve(work *w, shb_progress *progress, modal_result *first) {
  int threads = 1;
  allocate(w->out, w);
  w->out->models.model[0] = first->model;
  w->out->check[0]        = first->eigen.check;
  FEM_PETSC(modal_eigen_drop_factor(&first->eigen));
  if (!has_columns(first, w->out->models.n)) first->residual.n = 0;
  FEM_PETSC(fem_sector_create(w->body, w->state, &first->system, &w->matrices));
  SHB_TRY(fem_sector_analyse(&w->matrices, &w->order));
  SHB_TRY(count_threads(w, &threads));
  modal_phase(first->system.comm, progress, "sector",
              "%d blocks couple the sides, %.3g GB a factor", w->matrices.n_coupled,
              1e-9 * fem_hermitian_bytes(w->order));
  shb_progress_show(progress, 85, "%d nodal diameters", w->out->models.n - 1);
  solve_all(w, threads);
  SHB_TRY(report(w));
  modal_phase(first->system.comm, progress, "nodal diameters", "%d on %d threads",
              w->out->models.n - 1, threads);
  note(w, progress);
  return SHB_OK;
}

shb_status modal_sector_solve(const mesh_fe *mesh, const modal_settings *settings,
                              shb_progress *progress, modal_result *first,
                              modal_sector_tracks *tracks, modal_sector *sector) {
  modal_body *body = NULL;
  memset(sector, 0, sizeof *sector);
  modal_sector_list(settings, &sector->models);
  shb_status status = modal_body_create(mesh, settings, &body);
  if (status == SHB_OK) {
    work w = {.body     = &body->body,
              .state    = first->deflection.at.displacement,
              .settings = settings,
              .first    = first,
              .tracks   = tracks,
              .out      = sector};
    status = solve(&w, progress, first);
    fem_hermitian_order_free(w.order);
    fem_sector_free(&w.matrices);
    free(w.status);
    free(w.message);
  }
  free(body);
  return status;
}

/* Models of the main speed are those of the sector. */
static void free_speeds(modal_sector *sector) {
  modal_sector_speeds *speeds = &sector->speeds;
  for (int i = 0; i < speeds->n && sector->models.model; i++) {
    modal_speeds *at = &speeds->at[i];
    for (int s = 0; s < at->n; s++) {
      if (at->model[s].frequency != sector->models.model[i].frequency) continue;
      at->model[s] = (modal_model){0};
      if (at->imaginary) at->imaginary[s] = at->backward[s] = (modal_model){0};
    }
  }
  modal_sector_speeds_free(speeds);
}

void modal_sector_free(modal_sector *sector, const modal_result *first) {
  free_speeds(sector);
  if (sector->models.model && sector->models.model[0].frequency == first->model.frequency)
    memset(&sector->models.model[0], 0, sizeof sector->models.model[0]);
  for (int i = 0; sector->fields && i < sector->models.n; i++) wave_fields_free(&sector->fields[i]);
  modal_nodal_diameters_free(&sector->models);
  free(sector->fields);
  free(sector->check);
  memset(sector, 0, sizeof *sector);
}
