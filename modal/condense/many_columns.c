#include "modal/condense/many_columns.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/body/mass_product.h"
#include "fem/solver/petsc_error.h"
#include "mesh/base/memory.h"

/* BATCH: columns of a solution. BATCH_NUMBERS: numbers in a matrix of them, more save no time but
 * need memory. CHOSEN: dofs of S, at most. HELD_OUT: those at which the error is measured. */
enum {
  BLOCKS        = MODAL_RESIDUAL_BLOCKS,
  BATCH         = 80,
  LEAST_BATCH   = 40,
  BATCH_NUMBERS = 1 << 24,
  CHOSEN        = 80,
  HELD_OUT      = 8
};

static const double MOST_LEFT_OUT = 1e-8; /* of R3 */

typedef struct {
  const fem_system         *system;
  const modal_eigen        *eigen;
  const modal_condensation *to;
  shb_progress             *progress;
  modal_model              *model;
  int                       n; /* contact dofs */
  modal_residual_chain      chain;
  bool                     *node;    /* [free nodes of this rank] has a contact or probe dof */
  int                       chosen;  /* dofs of S */
  modal_dofs                subset;  /* S */
  int                      *dof;     /* [n] the contact dof of each pivot; S are the first */
  double                   *L;       /* [chosen][chosen] factor of R3_SS, lower triangle by rows */
  double                   *weight;  /* [chosen][n] C */
  double                   *tail[2]; /* [n + patterns] mu_4, mu_5 */
} workspace;

static int batch_size(const workspace *w) {
  const double room = (double)BATCH_NUMBERS / (3. * (double)w->system->n_free);
  const int    size = (int)fmin(fmax(room, LEAST_BATCH), BATCH) / LEAST_BATCH * LEAST_BATCH;
  return w->n < size ? w->n : size;
}

static void allocate(workspace *w) {
  const size_t n = (size_t)w->n, patterns = (size_t)w->to->load.dofs.n;
  w->node   = shb_alloc_zeroed((size_t)(w->system->last - w->system->first) + 1, sizeof *w->node);
  w->dof    = shb_alloc(n + 1, sizeof *w->dof);
  w->L      = shb_alloc(CHOSEN * CHOSEN, sizeof *w->L);
  w->weight = shb_alloc(CHOSEN * n, sizeof *w->weight);
  for (int i = 0; i < 2; i++) w->tail[i] = shb_alloc_zeroed(n + patterns + 1, sizeof(double));
}

static void mark(const workspace *w, const modal_dofs *dofs) {
  for (int e = 0; e < dofs->n_entries; e++) {
    const PetscInt row = w->system->row[dofs->node[e]];
    if (row >= w->system->first && row < w->system->last) w->node[row - w->system->first] = true;
  }
}

/* ------------------------------------------------------------------ R and R2 */

static shb_status show(const workspace *w, double share, int first) {
  int stop = shb_interrupted();
  MPI_Allreduce(MPI_IN_PLACE, &stop, 1, MPI_INT, MPI_MAX, w->system->comm);
  SHB_CHECK(!stop, SHB_INTERRUPTED, "interrupted");
  shb_progress_show(w->progress, 80 + 15 * share, "residuals: column %d of %d", first, w->n);
  return SHB_OK;
}

/* All contact dofs, then all probes, as weighted sums of the rows of K. */
typedef struct {
  int     n;
  int    *start, *row;
  double *weight;
} row_sums;

static void append_sums(const fem_system *system, const modal_dofs *dofs, row_sums *sums) {
  for (int c = 0; c < dofs->n; c++) {
    int at = sums->start[sums->n];
    for (int e = dofs->start[c]; e < dofs->start[c + 1]; e++) {
      const PetscInt node = system->row[dofs->node[e]];
      if (node < 0) continue;
      fem_system_to_row(system, dofs->node[e], dofs->weight + 3 * (size_t)e, sums->weight + at);
      for (int d = 0; d < 3; d++) sums->row[at++] = 3 * (int)node + d;
    }
    sums->start[++sums->n] = at;
  }
}

static void list_sums(const workspace *w, row_sums *sums) {
  const modal_dofs *contact = &w->to->contact, *probe = &w->to->probe;
  const size_t      n = (size_t)contact->n_entries + (size_t)probe->n_entries;
  sums->start         = shb_alloc_zeroed((size_t)(contact->n + probe->n) + 1, sizeof *sums->start);
  sums->row           = shb_alloc(3 * n + 1, sizeof *sums->row);
  sums->weight        = shb_alloc(3 * n + 1, sizeof *sums->weight);
  append_sums(w->system, contact, sums);
  append_sums(w->system, probe, sums);
}

/* Rows of R or R2 of the contact dofs and of the probes. */
static void put_term(const workspace *w, const double *term, double *contact, double *probe) {
  const size_t n = (size_t)w->n, all = n + (size_t)w->to->probe.n;
  for (size_t s = 0; s < all; s++)
    memcpy(s < n ? contact + s * n : probe + (s - n) * n, term + s * all, n * sizeof *term);
}

static bool go_on(void *context, double share) {
  const workspace *w = context;
  shb_progress_show(w->progress, 80 + 12 * share, "residuals: %d columns, %.0f %%", w->n,
                    100 * share);
  return !shb_interrupted();
}

/* R and R2 by the condensed mass of subtrees (fem/supernodal/unit_loads.h). */
static shb_status solve_by_tree(workspace *w, const fem_tree *tree, const fem_mass_rows *mass,
                                fem_loads_end *end) {
  const size_t  all  = (size_t)w->n + (size_t)w->to->probe.n;
  double       *R    = shb_alloc(all * all + 1, sizeof *R);
  double       *R2   = shb_alloc(all * all + 1, sizeof *R2);
  row_sums      sums = {0};
  const double *phi;
  list_sums(w, &sums);
  FEM_PETSC(MatDenseGetArrayRead(w->eigen->phi, &phi));
  const fem_unit_loads loads = {.tree        = *tree,
                                .node_start  = mass->start,
                                .node_column = mass->column,
                                .node_mass   = mass->value,
                                .modes       = w->eigen->n,
                                .phi         = phi,
                                .lambda      = w->eigen->lambda,
                                .n_loads     = sums.n,
                                .start       = sums.start,
                                .row         = sums.row,
                                .weight      = sums.weight,
                                .go_on       = go_on,
                                .context     = w,
                                .room        = shb_memory_available()};
  *end                       = fem_unit_loads_solve(&loads, R, R2);
  FEM_PETSC(MatDenseRestoreArrayRead(w->eigen->phi, &phi));
  if (*end == FEM_LOADS_SOLVED) {
    put_term(w, R, w->model->residual_flexibility, w->model->probe_contact_residual);
    put_term(w, R2, w->model->residual_inertia, w->model->probe_contact_inertia);
  }
  free(sums.start);
  free(sums.row);
  free(sums.weight);
  free(R);
  free(R2);
  SHB_CHECK(*end != FEM_LOADS_STOPPED, SHB_INTERRUPTED, "interrupted");
  return SHB_OK;
}

/* The same if there is one rank with room for it.
 *   done  out  false: there is not */
static shb_status try_tree(workspace *w, bool *done) {
  fem_tree      tree;
  fem_mass_rows mass;
  fem_loads_end end      = FEM_LOADS_NO_ROOM;
  bool          by_nodes = false;
  shb_status    status   = SHB_OK;
  *done                  = false;
  if (!fem_factor_tree(w->eigen->factor, &tree)) return SHB_OK;
  FEM_PETSC(fem_mass_borrow(w->system->M, &by_nodes, &mass));
  if (!by_nodes) return SHB_OK;
  status = solve_by_tree(w, &tree, &mass, &end);
  FEM_PETSC(fem_mass_give_back(w->system->M, &mass));
  *done = end == FEM_LOADS_SOLVED;
  return status;
}

static shb_status fill_two_terms(workspace *w) {
  const int batch = batch_size(w);
  bool      done;
  SHB_TRY(try_tree(w, &done));
  if (done) return SHB_OK;
  mark(w, &w->to->contact);
  mark(w, &w->to->probe);
  FEM_PETSC(modal_residual_chain_create(w->system, w->eigen, &w->to->contact, &w->to->probe, batch,
                                        &w->chain));
  for (int first = 0; first < w->n; first += batch) {
    const int count = w->n - first < batch ? w->n - first : batch;
    SHB_TRY(show(w, 0.8 * first / w->n, first));
    FEM_PETSC(modal_residual_chain_compute_two(&w->chain, &w->to->contact, w->node, first, count));
    for (int t = 0; t < 2; t++) modal_residual_terms_put(&w->chain, t, first, count, w->model);
  }
  FEM_PETSC(modal_residual_chain_destroy(&w->chain));
  return SHB_OK;
}

/* ------------------------------------------------------------------ R3 */

/* The first pivots of a Cholesky factor of R2. */
static shb_status choose(workspace *w) {
  const size_t n  = (size_t)w->n;
  double      *R2 = shb_alloc(n * n, sizeof *R2);
  lapack_int   rank;
  memcpy(R2, w->model->residual_inertia, n * n * sizeof *R2);
  const int info = LAPACKE_dpstrf(LAPACK_COL_MAJOR, 'L', w->n, R2, w->n, w->dof, &rank, -1);
  free(R2);
  SHB_CHECK(info >= 0, SHB_ERR_IO, "LAPACK's pivoted Cholesky factor failed (%d)", info);
  w->chosen = rank < CHOSEN ? rank : CHOSEN;
  for (int i = 0; i < w->chosen; i++)
    modal_dofs_append_one(&w->subset, &w->to->contact, --w->dof[i]);
  return SHB_OK;
}

/* Factor R3_SS = L L^T. Where rounding ends it, S is cut there. */
static shb_status factorise(workspace *w) {
  const int k = w->chosen;
  for (int i = 0; i < k; i++)
    for (int j = 0; j <= i; j++)
      w->L[i * k + j] = w->chain.sample[2][(size_t)w->dof[i] * (size_t)k + (size_t)j];
  const int info = LAPACKE_dpotrf(LAPACK_ROW_MAJOR, 'L', k, w->L, k);
  SHB_CHECK(info >= 0 && info != 1, SHB_ERR_IO, "LAPACK's Cholesky factor failed (%d)", info);
  if (info > 0) w->chosen = info - 1;
  return SHB_OK;
}

/* Part of R3 that the last dofs of S would lack without themselves, over the greatest flexibility.
 * The frequency is a third of the last mode's. */
static double measure(const workspace *w, int columns) {
  const double s    = w->eigen->lambda[w->eigen->n - 1] / 9;
  const int    from = w->chosen > HELD_OUT ? w->chosen - HELD_OUT : 0;
  double       most = 0, worst = 0;
  for (size_t c = 0; c < (size_t)w->n; c++)
    most = fmax(most, w->model->residual_flexibility[c * (size_t)w->n + c]);
  for (int i = from; i < w->chosen; i++) {
    double left = 0;
    for (int j = from; j <= i; j++) left += w->L[i * columns + j] * w->L[i * columns + j];
    worst = fmax(worst, left);
  }
  return s * s * worst / most;
}

/* C = (R3_SS)^-1 R3_S, and R3 = T^T T with T = L^-1 R3_S. */
static void combine(workspace *w, int columns) {
  const int n = w->n, k = w->chosen;
  for (int i = 0; i < k; i++)
    for (int c = 0; c < n; c++)
      w->weight[(size_t)i * (size_t)n + (size_t)c] =
          w->chain.sample[2][(size_t)c * (size_t)columns + (size_t)i];
  cblas_dtrsm(CblasRowMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, k, n, 1, w->L,
              columns, w->weight, n);
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, n, n, k, 1, w->weight, n, w->weight, n, 0,
              w->model->residual_fourth, n);
  cblas_dtrsm(CblasRowMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit, k, n, 1, w->L,
              columns, w->weight, n);
  if (w->to->probe.n > 0)
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, w->to->probe.n, n, k, 1,
                w->chain.probe_sample[2], columns, w->weight, n, 0, w->model->probe_contact_fourth,
                n);
}

/* mu_4 and mu_5 of each contact dof, c^T mu_SS c with its column c of C. */
static void combine_tails(workspace *w, int columns) {
  for (int i = 0; i < 2; i++) {
    const double *mu = w->chain.moment[BLOCKS + i];
    for (int c = 0; c < w->n; c++) {
      const double *own = w->weight + c;
      double        sum = 0;
      for (int a = 0; a < w->chosen; a++)
        for (int b = 0; b < w->chosen; b++)
          sum +=
              own[(size_t)a * (size_t)w->n] * mu[a * columns + b] * own[(size_t)b * (size_t)w->n];
      w->tail[i][c] = fmax(sum, 0);
    }
  }
}

static shb_status compress_third_term(workspace *w, double *left_out) {
  SHB_TRY(show(w, 0.8, w->n));
  SHB_TRY(choose(w));
  const int columns = w->chosen;
  SHB_CHECK(columns > 0, SHB_ERR_IO, "the contact has no residual inertia");
  FEM_PETSC(modal_residual_chain_create(w->system, w->eigen, &w->to->contact, &w->to->probe,
                                        columns, &w->chain));
  FEM_PETSC(modal_residual_chain_compute(&w->chain, &w->subset, 0, columns, BLOCKS));
  SHB_TRY(factorise(w));
  *left_out = measure(w, columns);
  if (*left_out <= MOST_LEFT_OUT) {
    combine(w, columns);
    combine_tails(w, columns);
  }
  FEM_PETSC(modal_residual_chain_destroy(&w->chain));
  return SHB_OK;
}

/* ------------------------------------------------------------------ three solutions a column */

/* mu_4 and mu_5 of the columns of the chain are the tails from index at on. */
static void take_tails(workspace *w, int at, int count) {
  for (int i = 0; i < 2; i++)
    for (int c = 0; c < count; c++)
      w->tail[i][at + c] = w->chain.moment[BLOCKS + i][(size_t)c * ((size_t)w->chain.batch + 1)];
}

static shb_status fill_third_term(workspace *w) {
  const int batch = batch_size(w);
  FEM_PETSC(modal_residual_chain_create(w->system, w->eigen, &w->to->contact, &w->to->probe, batch,
                                        &w->chain));
  for (int first = 0; first < w->n; first += batch) {
    const int count = w->n - first < batch ? w->n - first : batch;
    SHB_TRY(show(w, 0.8 + 0.15 * first / w->n, first));
    FEM_PETSC(modal_residual_chain_compute(&w->chain, &w->to->contact, first, count, BLOCKS));
    modal_residual_terms_put(&w->chain, BLOCKS - 1, first, count, w->model);
    take_tails(w, first, count);
  }
  FEM_PETSC(modal_residual_chain_destroy(&w->chain));
  return SHB_OK;
}

static shb_status fill_load(workspace *w) {
  const modal_load *load = &w->to->load;
  const int         n = load->dofs.n, most = batch_size(w), batch = n < most ? n : most;
  if (n == 0) return SHB_OK;
  FEM_PETSC(modal_residual_chain_create(w->system, w->eigen, &w->to->contact, &w->to->probe, batch,
                                        &w->chain));
  for (int first = 0; first < n; first += batch) {
    const int count = n - first < batch ? n - first : batch;
    SHB_TRY(show(w, 0.95, w->n));
    FEM_PETSC(modal_residual_chain_compute(&w->chain, &load->dofs, first, count, BLOCKS));
    modal_residual_terms_add_load(&w->chain, 0, load, first, count, w->model);
    take_tails(w, w->n + first, count);
  }
  return SHB_OK;
}

static shb_status fill(workspace *w, double *left_out) {
  allocate(w);
  SHB_TRY(fill_two_terms(w));
  SHB_TRY(compress_third_term(w, left_out));
  if (*left_out > MOST_LEFT_OUT) {
    SHB_TRY(fill_third_term(w));
    *left_out = 0;
  }
  SHB_TRY(fill_load(w));
  modal_residual_terms_symmetrise(w->model);
  modal_store_tails(BLOCKS, w->n, w->tail, &w->to->load, w->model);
  return SHB_OK;
}

shb_status modal_many_columns_fill(const fem_system *system, const modal_eigen *eigen,
                                   const modal_condensation *to, shb_progress *progress,
                                   modal_model *model, double *left_out) {
  workspace  w      = {.system   = system,
                       .eigen    = eigen,
                       .to       = to,
                       .progress = progress,
                       .model    = model,
                       .n        = to->contact.n};
  shb_status status = fill(&w, left_out);
  FEM_PETSC(modal_residual_chain_destroy(&w.chain));
  modal_dofs_free(&w.subset);
  free(w.node);
  free(w.dof);
  free(w.L);
  free(w.weight);
  free(w.tail[0]);
  free(w.tail[1]);
  return status;
}
