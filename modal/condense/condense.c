#include "modal/condense/condense.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/body/mass_product.h"
#include "fem/solver/petsc_error.h"
#include "mesh/base/constants.h"
#include "modal/common/phases.h"
#include "modal/condense/residual_modes.h"

/* Most of each. BATCH: right-hand sides per solve. BATCH_NUMBERS: numbers in a matrix of them. More
 * save no time but need memory. MAX_COLUMNS: columns of which residual modes are made, all at once.
 * MAX_NUMBERS: numbers in their vectors. */
enum {
  BATCH         = 80,
  LEAST_BATCH   = 40,
  BATCH_NUMBERS = 1 << 24,
  MAX_COLUMNS   = 96,
  BLOCKS        = MODAL_RESIDUAL_BLOCKS,
  MAX_NUMBERS   = 1 << 27
};

/* Contribution of a residual mode that is not kept, relative to the largest receptance, at half the
 * eigenvalue of the last mode. */
static const double NEGLIGIBLE = 1e-10;

/* Right-hand sides: contact dofs, then load patterns, whose residual terms are wanted. Then, if
 * they fit, the probes: residual modes made of them too are as accurate there. And the matrices of
 * one batch of them. V_i and mu_i are those of modal/condense/residual_modes.h. */
typedef struct {
  int                       batch; /* columns */
  const fem_system         *system;
  const modal_eigen        *eigen;
  const modal_condensation *to;
  int                       n_contact, n_term, n_column; /* n_term without the probes */
  modal_dofs                column;
  Mat                       B, X, Y; /* [3 n_free][batch] */
  double *sample[BLOCKS];            /* [column][batch] V_0, V_1, V_2 at the columns' own dofs */
  double *probe[BLOCKS];             /* [probe dof][batch] */
  double *moment[2 * BLOCKS];        /* [batch][batch] mu_1 .. mu_6 */
  double *tail[2];                   /* [column] mu_4, mu_5, or mu_7, mu_8 with residual modes */
} workspace;

static shb_status allocate(const modal_condensation *to, int n_modes, modal_model *model) {
  const size_t m = (size_t)n_modes, pairs = (size_t)to->n_pairs, nc = (size_t)to->contact.n;
  const size_t q3 = (size_t)to->probe.n, k = (size_t)to->load.n_harmonics + 1;
  model->n_modes  = n_modes;
  model->n_pairs  = to->n_pairs;
  model->has_left = to->has_left;
  model->n_probes = to->probe.n / 3;
  model->n_load   = to->load.n_harmonics;
  const struct {
    double **array;
    size_t   n;
  } real[]                           = {{&model->frequency, m},
                                        {&model->damping_ratio, m},
                                        {&model->eigen_residual, m},
                                        {&model->right, 3 * pairs * m},
                                        {&model->left, to->has_left ? 3 * pairs * m : 0},
                                        {&model->probe, q3 * m + 1},
                                        {&model->residual_flexibility, nc * nc},
                                        {&model->residual_inertia, nc * nc},
                                        {&model->residual_fourth, nc * nc},
                                        {&model->probe_contact_residual, q3 * nc + 1},
                                        {&model->probe_contact_inertia, q3 * nc + 1},
                                        {&model->probe_contact_fourth, q3 * nc + 1},
                                        {&model->contact_tail, 2 * nc},
                                        {&model->load_tail, 2 * k}};
  double complex **const complexes[] = {&model->modal_force,         &model->load_residual,
                                        &model->load_inertia,        &model->load_fourth,
                                        &model->probe_load_residual, &model->probe_load_inertia,
                                        &model->probe_load_fourth};
  bool                   made        = true;
  for (size_t i = 0; i < sizeof real / sizeof *real; i++)
    if (real[i].n > 0) made = (*real[i].array = calloc(real[i].n, sizeof(double))) && made;
  for (size_t i = 0; i < sizeof complexes / sizeof *complexes; i++) {
    const size_t n = i == 0 ? m : i < 4 ? nc : q3;
    *complexes[i]  = calloc(k * n + 1, sizeof(double complex));
    made           = *complexes[i] && made;
  }
  SHB_CHECK(made, SHB_ERR_IO, "out of memory for a modal model of %zu contact dofs", nc);
  return SHB_OK;
}

static PetscErrorCode fill_shapes(const workspace *w, modal_model *model) {
  const modal_condensation *to = w->to;
  const int                 m = w->eigen->n, nc = to->contact.n;
  double                   *shape, *force;

  PetscFunctionBeginUser;
  const modal_load *load = &to->load;
  PetscCall(PetscMalloc2((size_t)nc * (size_t)m + 1, &shape, load->dofs.n * (size_t)m + 1, &force));
  PetscCall(modal_dofs_sample(&to->contact, w->system, w->eigen->phi, m, m, shape));
  PetscCall(modal_dofs_sample(&to->probe, w->system, w->eigen->phi, m, m, model->probe));
  PetscCall(modal_dofs_sample(&load->dofs, w->system, w->eigen->phi, m, m, force));
  size_t side = 3 * (size_t)to->n_pairs * (size_t)m;
  if (side > 0) memcpy(model->right, shape, side * sizeof(double));
  if (to->has_left) memcpy(model->left, shape + side, side * sizeof(double));
  for (int k = 0; k <= model->n_load; k++)
    for (int c = 0; c < load->dofs.n; c++)
      for (int i = 0; i < m; i++)
        model->modal_force[k * m + i] += load->weight[k * load->dofs.n + c] * force[c * m + i];
  for (int i = 0; i < m; i++) {
    model->frequency[i]      = sqrt(w->eigen->lambda[i]) / SHB_TWO_PI;
    model->eigen_residual[i] = w->eigen->eigen_residual[i];
  }
  PetscCall(PetscFree2(shape, force));
  PetscFunctionReturn(0);
}

/* X = P K^-1 B */
static PetscErrorCode solve(workspace *w, Mat X) {
  PetscFunctionBeginUser;
  PetscCall(modal_eigen_inverse(w->eigen, w->B, X));
  PetscCall(modal_eigen_project_out(w->system, w->eigen, X));
  PetscFunctionReturn(0);
}

/* product[batch][batch] = X^T Y */
static PetscErrorCode products(const workspace *w, Mat X, Mat Y, double *product) {
  const PetscScalar *x, *y;
  PetscInt           rows, lx, ly;
  const int          n = w->batch;
  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(X, &rows, NULL));
  PetscCall(MatDenseGetLDA(X, &lx));
  PetscCall(MatDenseGetLDA(Y, &ly));
  PetscCall(MatDenseGetArrayRead(X, &x));
  PetscCall(MatDenseGetArrayRead(Y, &y));
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, n, n, (int)rows, 1, x, (int)lx, y, (int)ly,
              0, product, n);
  PetscCall(MatDenseRestoreArrayRead(Y, &y));
  PetscCall(MatDenseRestoreArrayRead(X, &x));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, product, n * n, MPI_DOUBLE, MPI_SUM, w->system->comm));
  PetscFunctionReturn(0);
}

/* tail[first + c] = X_c . Y_c */
static PetscErrorCode column_products(Mat X, Mat Y, int first, int count, double *tail) {
  Vec x, y;
  PetscFunctionBeginUser;
  for (int c = 0; c < count; c++) {
    PetscCall(MatDenseGetColumnVecRead(X, c, &x));
    PetscCall(MatDenseGetColumnVecRead(Y, c, &y));
    PetscCall(VecDot(x, y, &tail[first + c]));
    PetscCall(MatDenseRestoreColumnVecRead(Y, c, &y));
    PetscCall(MatDenseRestoreColumnVecRead(X, c, &x));
  }
  PetscFunctionReturn(0);
}

/* Compute V_0, V_1, ... of a batch and sample each. The products V_i . M V_i and V_(i+1) . M V_i
 * are the moments mu_(2i+2) and mu_(2i+3). If all columns are in one batch the moments are
 * matrices, and one further V gives the tail. */
static PetscErrorCode compute_chain(workspace *w, int first, int count, bool single_batch) {
  const int last = single_batch ? BLOCKS : BLOCKS - 1, b = w->batch;
  Mat       V = w->X, next = w->Y;
  PetscFunctionBeginUser;
  PetscCall(modal_dofs_spread(&w->column, w->system, first, count, w->B));
  PetscCall(solve(w, V));
  for (int i = 0;; i++) {
    if (i < BLOCKS) {
      PetscCall(modal_dofs_sample(&w->column, w->system, V, b, b, w->sample[i]));
      PetscCall(modal_dofs_sample(&w->to->probe, w->system, V, b, b, w->probe[i]));
    }
    if (i == last && !single_batch) break;
    PetscCall(fem_mass_multiply(w->system->M, V, w->B));
    if (single_batch && i < BLOCKS) PetscCall(products(w, V, w->B, w->moment[2 * i + 1]));
    if (single_batch && i == BLOCKS) PetscCall(column_products(V, w->B, first, count, w->tail[1]));
    if (!single_batch && i == 1) PetscCall(column_products(V, w->B, first, count, w->tail[0]));
    if (i == last) break;
    PetscCall(solve(w, next));
    if (i + 1 < BLOCKS && single_batch) PetscCall(products(w, next, w->B, w->moment[2 * i + 2]));
    if (i + 1 == last)
      PetscCall(column_products(next, w->B, first, count, w->tail[single_batch ? 0 : 1]));
    Mat done = V;
    V        = next;
    next     = done;
  }
  if (single_batch) memcpy(w->moment[0], w->sample[0], (size_t)(b * b) * sizeof(double));
  PetscFunctionReturn(0);
}

/* Columns first .. first + count - 1 of to [rows][columns] from the samples [rows][batch]. */
static void put_columns(const workspace *w, const double *sample, int rows, int first, int count,
                        double *to) {
  const size_t columns = (size_t)w->n_contact, batch = (size_t)w->batch;
  for (size_t r = 0; r < (size_t)rows; r++)
    for (int c = 0; c < count; c++)
      to[r * columns + (size_t)(first + c)] = sample[r * batch + (size_t)c];
}

/* Add column c of the samples, times the weight of the pattern in each harmonic. */
static void add_load(const workspace *w, int pattern, const double *sample, int c, int rows,
                     double complex *to) {
  const modal_load *load = &w->to->load;
  for (int k = 0; k <= load->n_harmonics; k++)
    for (int r = 0; r < rows; r++)
      to[(size_t)k * (size_t)rows + (size_t)r] +=
          load->weight[k * load->dofs.n + pattern] * sample[r * w->batch + c];
}

static void store_terms(const workspace *w, int first, int count, modal_model *model) {
  const int       nc = w->n_contact, q3 = w->to->probe.n;
  const int       contacts        = first + count <= nc ? count : PetscMax(nc - first, 0);
  const int       terms           = PetscMin(count, w->n_term - first);
  double         *contact[]       = {model->residual_flexibility, model->residual_inertia,
                                     model->residual_fourth};
  double         *probe_contact[] = {model->probe_contact_residual, model->probe_contact_inertia,
                                     model->probe_contact_fourth};
  double complex *load[]          = {model->load_residual, model->load_inertia, model->load_fourth};
  double complex *probe_load[]    = {model->probe_load_residual, model->probe_load_inertia,
                                     model->probe_load_fourth};
  for (int t = 0; t < BLOCKS; t++) {
    put_columns(w, w->sample[t], nc, first, contacts, contact[t]);
    put_columns(w, w->probe[t], q3, first, contacts, probe_contact[t]);
    for (int c = contacts; c < terms; c++) {
      add_load(w, first + c - nc, w->sample[t], c, nc, load[t]);
      add_load(w, first + c - nc, w->probe[t], c, q3, probe_load[t]);
    }
  }
}

void modal_store_tails(int order, int n_contact, double *const tail[2], const modal_load *load,
                       modal_model *model) {
  const double *first = tail[0] + n_contact, *second = tail[1] + n_contact; /* of the patterns */
  double        ratio = 0;
  model->tail_order   = order;
  for (int c = 0; c < n_contact; c++)
    for (int i = 0; i < 2; i++) model->contact_tail[2 * c + i] = tail[i][c];
  for (int c = 0; c < load->dofs.n; c++)
    if (first[c] > 0) ratio = fmax(ratio, second[c] / first[c]);
  for (int k = 0; k <= load->n_harmonics; k++) {
    double root = 0;
    for (int c = 0; c < load->dofs.n; c++)
      root += cabs(load->weight[k * load->dofs.n + c]) * sqrt(first[c]);
    model->load_tail[2 * k]     = root * root;
    model->load_tail[2 * k + 1] = root * root * ratio;
  }
}

/* psi[rows][n] = sum_i sample_i weight_i */
static void ritz_shapes(const workspace *w, const modal_residual_modes *ritz, int rows,
                        double *const sample[BLOCKS], double *psi) {
  const int b = w->batch, n = ritz->n;
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

static void store_residual_modes(const workspace *w, const modal_residual_modes *ritz, int kept,
                                 const double *psi, const double *at_probe, modal_model *model) {
  const modal_load *load = &w->to->load;
  const int         n = ritz->n, nc = w->n_contact;
  for (int i = 0; i < kept; i++) {
    model->residual_frequency[i] = sqrt(ritz->lambda[i]) / SHB_TWO_PI;
    for (int c = 0; c < nc; c++) model->residual_shape[c * kept + i] = psi[c * n + i];
    for (int c = 0; c < w->to->probe.n; c++)
      model->residual_probe[c * kept + i] = at_probe[c * n + i];
    for (int k = 0; k <= load->n_harmonics; k++)
      for (int c = 0; c < load->dofs.n; c++)
        model->residual_force[k * kept + i] +=
            load->weight[k * load->dofs.n + c] * psi[(nc + c) * n + i];
  }
}

/* Scale of each column: the largest contact receptance for contact dofs, its own for a load pattern
 * or a probe. */
static void set_scales(const workspace *w, double *scale) {
  const size_t next = (size_t)w->batch + 1;
  double       most = 0;
  for (int c = 0; c < w->n_contact; c++) most = fmax(most, w->moment[0][(size_t)c * next]);
  for (int c = 0; c < w->n_column; c++)
    scale[c] = c < w->n_contact ? most : w->moment[0][(size_t)c * next];
}

static shb_status select_residual_modes(workspace *w, const modal_residual_modes *ritz, double *psi,
                                        double *at_probe, modal_model *model) {
  const double last = w->eigen->lambda[w->eigen->n - 1];
  double       scale[MAX_COLUMNS];
  ritz_shapes(w, ritz, w->n_column, w->sample, psi);
  ritz_shapes(w, ritz, w->to->probe.n, w->probe, at_probe);
  subtract_ritz_tails(w, ritz, psi);
  set_scales(w, scale);
  const int kept = modal_residual_modes_needed(ritz, w->n_column, psi, scale, last / 2, NEGLIGIBLE);
  const size_t r = (size_t)kept;
  model->n_residual         = kept;
  model->residual_frequency = calloc(r + 1, sizeof(double));
  model->residual_shape     = calloc((size_t)w->n_contact * r + 1, sizeof(double));
  model->residual_probe     = calloc((size_t)w->to->probe.n * r + 1, sizeof(double));
  model->residual_force     = calloc(((size_t)model->n_load + 1) * r + 1, sizeof(double complex));
  SHB_CHECK(model->residual_frequency && model->residual_shape && model->residual_probe &&
                model->residual_force,
            SHB_ERR_IO, "out of memory for residual modes");
  store_residual_modes(w, ritz, kept, psi, at_probe, model);
  return SHB_OK;
}

static shb_status create_residual_modes(workspace *w, modal_model *model) {
  modal_residual_modes ritz;
  SHB_TRY(modal_residual_modes_create(w->n_column, w->moment, &ritz));
  const size_t n    = (size_t)ritz.n;
  double      *psi  = malloc(((size_t)w->n_column * n + 1) * sizeof *psi),
         *at_probe  = malloc(((size_t)w->to->probe.n * n + 1) * sizeof *psi);
  shb_status status = psi && at_probe ? SHB_OK
                                      : shb_fail(SHB_ERR_IO, __FILE__, __LINE__,
                                                 "out of memory for residual modes");
  if (status == SHB_OK && ritz.n > 0)
    status = select_residual_modes(w, &ritz, psi, at_probe, model);
  free(psi);
  free(at_probe);
  modal_residual_modes_free(&ritz);
  return status;
}

/* Remove the rounding differences: the harmonic balance relies on symmetry. */
static void symmetrise(double *a, size_t n) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++) a[i * n + j] = a[j * n + i] = (a[i * n + j] + a[j * n + i]) / 2;
}

/* Residual modes need all columns in one batch. */
static bool fits_single_batch(const workspace *w, int n_column) {
  const double room = (double)MAX_NUMBERS / (3. * 3 * (double)w->system->n_free);
  return n_column <= MAX_COLUMNS && n_column <= room;
}

static shb_status create_columns(workspace *w) {
  const int with_probes = w->to->contact.n + w->to->load.dofs.n + w->to->probe.n;
  w->n_contact          = w->to->contact.n;
  w->n_column = w->n_term = w->n_contact + w->to->load.dofs.n;
  SHB_TRY(modal_dofs_append(&w->column, &w->to->contact));
  SHB_TRY(modal_dofs_append(&w->column, &w->to->load.dofs));
  if (w->n_contact > 0 && fits_single_batch(w, with_probes)) {
    w->n_column = with_probes;
    SHB_TRY(modal_dofs_append(&w->column, &w->to->probe));
  }
  for (int i = 0; i < 2; i++) {
    w->tail[i] = calloc((size_t)w->n_column + 1, sizeof(double));
    SHB_CHECK(w->tail[i], SHB_ERR_IO, "out of memory for the condensation");
  }
  return SHB_OK;
}

static PetscErrorCode create_batch(workspace *w, int batch) {
  const size_t b = (size_t)batch;
  PetscFunctionBeginUser;
  w->batch = batch;
  PetscCall(modal_dense_create(w->system, batch, &w->B));
  PetscCall(modal_dense_create(w->system, batch, &w->X));
  PetscCall(modal_dense_create(w->system, batch, &w->Y));
  for (int i = 0; i < BLOCKS; i++) {
    PetscCall(PetscMalloc1((size_t)w->n_column * b, &w->sample[i]));
    PetscCall(PetscMalloc1((size_t)w->to->probe.n * b, &w->probe[i]));
  }
  for (int i = 0; i < 2 * BLOCKS; i++) PetscCall(PetscMalloc1(b * b, &w->moment[i]));
  PetscFunctionReturn(0);
}

static PetscErrorCode destroy_workspace(workspace *w) {
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&w->B));
  PetscCall(MatDestroy(&w->X));
  PetscCall(MatDestroy(&w->Y));
  for (int i = 0; i < BLOCKS; i++) {
    PetscCall(PetscFree(w->sample[i]));
    PetscCall(PetscFree(w->probe[i]));
  }
  for (int i = 0; i < 2 * BLOCKS; i++) PetscCall(PetscFree(w->moment[i]));
  free(w->tail[0]);
  free(w->tail[1]);
  modal_dofs_free(&w->column);
  PetscFunctionReturn(0);
}

/* Columns of a batch where not all fit in one. */
static int batch_size(const workspace *w) {
  const double room = (double)BATCH_NUMBERS / (3. * (double)w->system->n_free);
  const int    size = (int)fmin(fmax(room, LEAST_BATCH), BATCH) / LEAST_BATCH * LEAST_BATCH;
  return w->n_column < size ? w->n_column : size;
}

/* Residual terms belong to contact dofs: without contact there are none. */
static void drop_residual_terms(modal_model *model) {
  free(model->load_tail);
  free(model->probe_load_residual);
  free(model->probe_load_inertia);
  free(model->probe_load_fourth);
  model->load_tail           = NULL;
  model->probe_load_residual = model->probe_load_inertia = model->probe_load_fourth = NULL;
}

static shb_status fill_modes(workspace *w, modal_model *model) {
  FEM_PETSC(fill_shapes(w, model));
  for (int i = 0; i < w->eigen->n; i++)
    SHB_TRY(modal_damping_ratio(&w->to->damping, i, sqrt(w->eigen->lambda[i]),
                                &model->damping_ratio[i]));
  return SHB_OK;
}

static shb_status fill(workspace *w, shb_progress *progress, modal_model *model) {
  SHB_TRY(create_columns(w));
  SHB_TRY(fill_modes(w, model));
  const int n = w->n_column, nc = w->n_contact;
  if (nc == 0) {
    drop_residual_terms(model);
    return SHB_OK;
  }
  const bool single_batch = fits_single_batch(w, w->n_column);
  const int  batch        = single_batch ? n : batch_size(w);
  FEM_PETSC(create_batch(w, batch));
  for (int first = 0; first < n; first += batch) {
    int count = n - first < batch ? n - first : batch, stop = shb_interrupted();
    MPI_Allreduce(MPI_IN_PLACE, &stop, 1, MPI_INT, MPI_MAX, w->system->comm);
    SHB_CHECK(!stop, SHB_INTERRUPTED, "interrupted");
    shb_progress_show(progress, 80 + 15. * first / n, "residuals: column %d of %d", first, n);
    FEM_PETSC(compute_chain(w, first, count, single_batch));
    store_terms(w, first, count, model);
  }
  symmetrise(model->residual_flexibility, (size_t)nc);
  symmetrise(model->residual_inertia, (size_t)nc);
  symmetrise(model->residual_fourth, (size_t)nc);
  if (single_batch) SHB_TRY(create_residual_modes(w, model));
  modal_store_tails(single_batch ? 2 * BLOCKS : BLOCKS, nc, w->tail, &w->to->load, model);
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
    modal_phase(system->comm, progress, "residuals", "%d contact dofs, %d residual modes",
                to->contact.n, model->n_residual);
  return status;
}
