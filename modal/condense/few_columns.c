#include "modal/condense/few_columns.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/solver/petsc_error.h"
#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "modal/condense/residual_modes.h"

/* MOST_NUMBERS: numbers in the vectors of all columns, at most. */
enum { BLOCKS = MODAL_RESIDUAL_BLOCKS, MOST_NUMBERS = 1 << 27 };

/* Contribution of a residual mode that is not kept, relative to the largest receptance, at half the
 * eigenvalue of the last mode. */
static const double NEGLIGIBLE = 1e-10;

/* Columns: contact dofs, then load patterns, whose residual terms are wanted. Then, if they fit,
 * the probes: residual modes made of them too are as accurate there. */
typedef struct {
  const modal_condensation *to;
  int                       n_contact, n_column;
  modal_dofs                column;
  modal_residual_chain      chain;
  double                   *tail[2]; /* [column] mu_7, mu_8 */
} workspace;

/* psi[rows][n] = sum_i sample_i weight_i */
static void ritz_shapes(const workspace *w, const modal_residual_modes *ritz, int rows,
                        double *const sample[BLOCKS], double *psi) {
  const int b = w->chain.batch, n = ritz->n;
  for (int i = 0; i < BLOCKS && rows > 0 && n > 0; i++)
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, rows, n, b, 1, sample[i], b,
                ritz->weight + (size_t)i * (size_t)b * (size_t)n, n, i > 0, psi, n);
}

/* Tail behind all residual modes: mu_7 and mu_8 minus theirs, at least the rounding of the
 * moments. */
static void subtract_ritz_tails(workspace *w, const modal_residual_modes *ritz, const double *psi) {
  static const double rounding = 1e-11;
  for (int c = 0; c < w->n_column; c++) {
    double a = w->tail[0][c], b = w->tail[1][c];
    for (int i = 0; i < ritz->n; i++) {
      double shape = psi[c * ritz->n + i];
      double term  = shape * shape / pow(ritz->lambda[i], 2 * BLOCKS + 1);
      a -= term;
      b -= term / ritz->lambda[i];
    }
    w->tail[0][c] = fmax(a, rounding * w->tail[0][c]);
    w->tail[1][c] = fmax(b, 0);
  }
}

/* The sign of mode i that does not depend on round-off: its largest motion at the contact, or at
 * any column without one, is positive. Of motions that are alike the first counts. */
static double sign_of(const workspace *w, int n, const double *psi, int i) {
  const double alike   = 0.999;
  const int    columns = w->n_contact > 0 ? w->n_contact : w->n_column;
  double       most    = 0;
  for (int c = 0; c < columns; c++) most = fmax(most, fabs(psi[c * n + i]));
  for (int c = 0; c < columns; c++)
    if (fabs(psi[c * n + i]) >= alike * most) return psi[c * n + i] < 0 ? -1 : 1;
  return 1;
}

static void store_residual_modes(const workspace *w, const modal_residual_modes *ritz, int kept,
                                 const double *psi, const double *at_probe, modal_model *model) {
  const modal_load *load = &w->to->load;
  const int         n = ritz->n, nc = w->n_contact;
  for (int i = 0; i < kept; i++) {
    const double sign            = sign_of(w, n, psi, i);
    model->residual_frequency[i] = sqrt(ritz->lambda[i]) / SHB_TWO_PI;
    for (int c = 0; c < nc; c++) model->residual_shape[c * kept + i] = sign * psi[c * n + i];
    for (int c = 0; c < w->to->probe.n; c++)
      model->residual_probe[c * kept + i] = sign * at_probe[c * n + i];
    for (int k = 0; k <= load->n_harmonics; k++)
      for (int c = 0; c < load->dofs.n; c++)
        model->residual_force[k * kept + i] +=
            load->weight[k * load->dofs.n + c] * sign * psi[(nc + c) * n + i];
  }
}

/* Scale of each column: the largest contact receptance for contact dofs, its own for a load pattern
 * or a probe. */
static void set_scales(const workspace *w, double *scale) {
  const size_t next = (size_t)w->chain.batch + 1;
  double       most = 0;
  for (int c = 0; c < w->n_contact; c++) most = fmax(most, w->chain.moment[0][(size_t)c * next]);
  for (int c = 0; c < w->n_column; c++)
    scale[c] = c < w->n_contact ? most : w->chain.moment[0][(size_t)c * next];
}

static void select_residual_modes(workspace *w, const modal_residual_modes *ritz, double *psi,
                                  double *at_probe, modal_model *model) {
  const double last = w->chain.eigen->lambda[w->chain.eigen->n - 1];
  double       scale[MODAL_FEW_COLUMNS];
  ritz_shapes(w, ritz, w->n_column, w->chain.sample, psi);
  ritz_shapes(w, ritz, w->to->probe.n, w->chain.probe_sample, at_probe);
  subtract_ritz_tails(w, ritz, psi);
  set_scales(w, scale);
  const int kept = modal_residual_modes_needed(ritz, w->n_column, psi, scale, last / 2, NEGLIGIBLE);
  const size_t r = (size_t)kept;
  model->n_residual         = kept;
  model->residual_frequency = shb_alloc_zeroed(r + 1, sizeof(double));
  model->residual_shape     = shb_alloc_zeroed((size_t)w->n_contact * r + 1, sizeof(double));
  model->residual_probe     = shb_alloc_zeroed((size_t)w->to->probe.n * r + 1, sizeof(double));
  model->residual_force =
      shb_alloc_zeroed(((size_t)model->n_load + 1) * r + 1, sizeof(double complex));
  store_residual_modes(w, ritz, kept, psi, at_probe, model);
}

static shb_status create_residual_modes(workspace *w, modal_model *model) {
  modal_residual_modes ritz;
  SHB_TRY(modal_residual_modes_create(w->n_column, w->chain.moment, &ritz));
  const size_t n        = (size_t)ritz.n;
  double      *psi      = shb_alloc((size_t)w->n_column * n, sizeof *psi);
  double      *at_probe = shb_alloc((size_t)w->to->probe.n * n, sizeof *at_probe);
  if (ritz.n > 0) select_residual_modes(w, &ritz, psi, at_probe, model);
  free(psi);
  free(at_probe);
  modal_residual_modes_free(&ritz);
  return SHB_OK;
}

static bool fit(const fem_system *system, int n_column) {
  const double room = (double)MOST_NUMBERS / (3. * 3 * (double)system->n_free);
  return n_column <= MODAL_FEW_COLUMNS && n_column <= room;
}

bool modal_columns_are_few(const fem_system *system, const modal_condensation *to) {
  return fit(system, to->contact.n + to->load.dofs.n);
}

static void create_columns(const fem_system *system, workspace *w) {
  const int with_probes = w->to->contact.n + w->to->load.dofs.n + w->to->probe.n;
  w->n_contact          = w->to->contact.n;
  w->n_column           = w->n_contact + w->to->load.dofs.n;
  modal_dofs_append(&w->column, &w->to->contact);
  modal_dofs_append(&w->column, &w->to->load.dofs);
  if (fit(system, with_probes)) {
    w->n_column = with_probes;
    modal_dofs_append(&w->column, &w->to->probe);
  }
  for (int i = 0; i < 2; i++)
    w->tail[i] = shb_alloc_zeroed((size_t)w->n_column + 1, sizeof(double));
}

static void take_tails(workspace *w) {
  const size_t next = (size_t)w->n_column + 1;
  for (int i = 0; i < 2; i++)
    for (int c = 0; c < w->n_column; c++)
      w->tail[i][c] = w->chain.moment[2 * BLOCKS + i][(size_t)c * next];
}

static shb_status fill(const fem_system *system, const modal_eigen *eigen, workspace *w,
                       modal_model *model) {
  create_columns(system, w);
  const int    n    = w->n_column;
  const size_t size = (size_t)n * (size_t)n * sizeof(double);
  FEM_PETSC(modal_residual_chain_create(system, eigen, &w->column, &w->to->probe, n, &w->chain));
  FEM_PETSC(modal_residual_chain_compute(&w->chain, &w->column, 0, n, BLOCKS + 1));
  memcpy(w->chain.moment[0], w->chain.sample[0], size);
  take_tails(w);
  for (int t = 0; t < BLOCKS; t++) modal_residual_terms_put(&w->chain, t, 0, w->n_contact, model);
  modal_residual_terms_add_load(&w->chain, w->n_contact, &w->to->load, 0, w->to->load.dofs.n,
                                model);
  modal_residual_terms_symmetrise(model);
  SHB_TRY(create_residual_modes(w, model));
  modal_store_tails(2 * BLOCKS, w->n_contact, w->tail, &w->to->load, model);
  return SHB_OK;
}

shb_status modal_few_columns_fill(const fem_system *system, const modal_eigen *eigen,
                                  const modal_condensation *to, modal_model *model) {
  workspace  w      = {.to = to};
  shb_status status = fill(system, eigen, &w, model);
  FEM_PETSC(modal_residual_chain_destroy(&w.chain));
  free(w.tail[0]);
  free(w.tail[1]);
  modal_dofs_free(&w.column);
  return status;
}
