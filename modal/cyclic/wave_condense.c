#include "modal/cyclic/wave_condense.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/supernodal/large_pages.h"
#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "modal/condense/residual_terms.h"
#include "modal/cyclic/wave_ritz.h"

/* As in modal/condense/condense.c. */
enum { BATCH = 32, MAX_COLUMNS = 96, BLOCKS = MODAL_RESIDUAL_BLOCKS, MAX_NUMBERS = 1 << 26 };
static const double NEGLIGIBLE = 1e-10;

static const double complex one = 1, zero = 0;

/* Right-hand sides: contact dofs, load patterns and, if they fit, the probes, as in
 * modal/condense/condense.c; and the vectors of one batch of them. V_i and mu_i are those of
 * modal/condense/residual_modes.h. */
typedef struct {
  wave_operator            *op;
  const wave_modes         *modes;
  const modal_condensation *to;
  modal_model              *model, *imaginary, *backward;
  int                       n_contact, n_term, n_column, batch;
  modal_dofs                column;
  double complex           *X, *Y, *MX;         /* [batch][order] */
  double complex           *C;                  /* [batch][modes] */
  double complex           *sample[BLOCKS];     /* [column][batch] V_0, V_1, V_2 at the columns */
  double complex           *probe[BLOCKS];      /* [probe dof][batch] */
  double complex           *moment[2 * BLOCKS]; /* [batch][batch] mu_1 .. mu_6 */
  double                   *tail[2];            /* [column] */
} workspace;

/* ------------------------------------------------------------------ dofs */

void wave_spread(const wave_operator *op, const modal_dofs *dofs, int first, int count, int columns,
                 double complex *X) {
  const size_t order = op->order;
  memset(X, 0, (size_t)columns * order * sizeof *X);
  for (int c = 0; c < count; c++)
    for (int e = dofs->start[first + c]; e < dofs->start[first + c + 1]; e++) {
      const int      row = op->sector->row[dofs->node[e]];
      double complex v[3];
      if (row < 0) continue;
      fem_sector_force(op->sector, dofs->node[e], op->phase, dofs->weight + 3 * (size_t)e, v);
      for (int d = 0; d < 3; d++) X[(size_t)c * order + 3 * (size_t)row + (size_t)d] += v[d];
    }
}

static double complex motion_of(const workspace *w, const modal_dofs *dofs, int c,
                                const double complex *x) {
  double complex sum = 0;
  for (int e = dofs->start[c]; e < dofs->start[c + 1]; e++) {
    double complex v[3];
    fem_sector_motion(w->op->sector, dofs->node[e], w->op->phase, x, v);
    for (int d = 0; d < 3; d++) sum += dofs->weight[3 * (size_t)e + (size_t)d] * v[d];
  }
  return sum;
}

/* value[c][k] = b_c^T C X[:, k]; stride numbers a row. */
static void sample(const workspace *w, const modal_dofs *dofs, const double complex *X, int columns,
                   int stride, double complex *value) {
  for (int c = 0; c < dofs->n; c++)
    for (int k = 0; k < columns; k++)
      value[(size_t)c * (size_t)stride + (size_t)k] =
          motion_of(w, dofs, c, X + (size_t)k * w->op->order);
}

/* ------------------------------------------------------------------ model */

/* Allocate the arrays of a model, its imaginary part and the load of the backward wave. */
static void allocate(const workspace *w) {
  const modal_condensation *to = w->to;
  w->model->n_modes            = w->modes->n;
  w->model->n_pairs            = to->n_pairs;
  w->model->has_left           = to->has_left;
  w->model->n_probes           = to->probe.n / 3;
  w->model->n_load             = to->load.n_harmonics;
  modal_model_allocate(w->model, w->imaginary, w->backward);
}

static void split(size_t n, const double complex *value, double *re, double *im) {
  for (size_t i = 0; i < n; i++) re[i] = creal(value[i]), im[i] = cimag(value[i]);
}

/* Add column value of a pattern in each harmonic, forward and, conjugate, backward.
 *   rows, stride  in  of value */
static void add_load(const workspace *w, int pattern, int rows, int stride,
                     const double complex *value, double complex *forward,
                     double complex *backward) {
  const modal_load *load = &w->to->load;
  for (int k = 0; k <= load->n_harmonics; k++)
    for (int r = 0; r < rows; r++) {
      const double complex weight = load->weight[k * load->dofs.n + pattern];
      forward[k * rows + r] += weight * value[r * stride];
      backward[k * rows + r] += weight * conj(value[r * stride]);
    }
}

static shb_status fill_shapes(const workspace *w) {
  const modal_condensation *to = w->to;
  const int                 m = w->modes->n, most = to->contact.n + to->probe.n + to->load.dofs.n;
  const size_t              side  = 3 * (size_t)to->n_pairs * (size_t)m;
  double complex           *value = shb_alloc((size_t)most * (size_t)m + 1, sizeof *value);
  sample(w, &to->contact, w->modes->phi, m, m, value);
  split(side, value, w->model->right, w->imaginary->right);
  if (to->has_left) split(side, value + side, w->model->left, w->imaginary->left);
  sample(w, &to->probe, w->modes->phi, m, m, value);
  split((size_t)to->probe.n * (size_t)m, value, w->model->probe, w->imaginary->probe);
  sample(w, &to->load.dofs, w->modes->phi, m, m, value);
  for (int c = 0; c < to->load.dofs.n; c++) { /* phi^H f is the conjugate of the pattern's motion */
    for (int i = 0; i < m; i++) value[c * m + i] = conj(value[c * m + i]);
    add_load(w, c, m, 1, value + (size_t)c * (size_t)m, w->model->modal_force,
             w->backward->modal_force);
  }
  free(value);
  for (int i = 0; i < m; i++) {
    w->model->frequency[i]      = sqrt(w->modes->lambda[i]) / SHB_TWO_PI;
    w->model->eigen_residual[i] = w->modes->eigen_residual[i];
    SHB_TRY(modal_damping_ratio(&to->damping, i, sqrt(w->modes->lambda[i]),
                                &w->model->damping_ratio[i]));
  }
  return SHB_OK;
}

/* ------------------------------------------------------------------ residual terms */

/* X = P K^-1 X of the batch. */
static void solve(workspace *w, double complex *B, double complex *X) {
  wave_operator_solve(w->op, w->batch, B, X);
  wave_modes_project_out(w->modes, w->batch, X, w->C);
}

/* product[a][b] = X_a^H Y_b by rows. */
static void products(const workspace *w, const double complex *X, const double complex *Y,
                     double complex *product) {
  const int b = w->batch;
  wave_inner(w->op->order, b, Y, b, X, product); /* Y_b^H X_a at [a][b] by rows */
  for (int i = 0; i < b * b; i++) product[i] = conj(product[i]);
}

/* tail[first + c] = X_c^H Y_c */
static void column_products(const workspace *w, const double complex *X, const double complex *Y,
                            int first, int count, double *tail) {
  for (int c = 0; c < count; c++) {
    double complex value;
    const size_t   at = (size_t)c * w->op->order;
    wave_inner(w->op->order, 1, X + at, 1, Y + at, &value);
    tail[first + c] = creal(value);
  }
}

/* V_0, V_1, ... of a batch, as compute_chain of modal/condense/condense.c. */
static void compute_chain(workspace *w, int first, int count, bool single_batch) {
  const int       last = single_batch ? BLOCKS : BLOCKS - 1, b = w->batch;
  double complex *V = w->X, *next = w->Y;
  wave_spread(w->op, &w->column, first, count, w->batch, w->MX);
  solve(w, w->MX, V);
  for (int i = 0;; i++) {
    if (i < BLOCKS) {
      sample(w, &w->column, V, b, b, w->sample[i]);
      sample(w, &w->to->probe, V, b, b, w->probe[i]);
    }
    if (i == last && !single_batch) break;
    wave_operator_mass(w->op, b, V, w->MX);
    if (single_batch && i < BLOCKS) products(w, V, w->MX, w->moment[2 * i + 1]);
    if (single_batch && i == BLOCKS) column_products(w, V, w->MX, first, count, w->tail[1]);
    if (!single_batch && i == 1) column_products(w, V, w->MX, first, count, w->tail[0]);
    if (i == last) break;
    solve(w, w->MX, next);
    /* solve may not change its right-hand side: MX = M V is still needed */
    if (i + 1 < BLOCKS && single_batch) products(w, next, w->MX, w->moment[2 * i + 2]);
    if (i + 1 == last) column_products(w, next, w->MX, first, count, w->tail[single_batch ? 0 : 1]);
    double complex *done = V;
    V                    = next;
    next                 = done;
  }
  if (single_batch) memcpy(w->moment[0], w->sample[0], (size_t)(b * b) * sizeof **w->moment);
}

/* Columns first .. first + count - 1 of to [rows][n_contact] from the samples [rows][batch]. */
static void put_columns(const workspace *w, const double complex *value, int rows, int first,
                        int count, double *re, double *im) {
  const size_t columns = (size_t)w->n_contact, batch = (size_t)w->batch;
  for (size_t r = 0; r < (size_t)rows; r++)
    for (int c = 0; c < count; c++) {
      const double complex v  = value[r * batch + (size_t)c];
      const size_t         at = r * columns + (size_t)(first + c);
      re[at] = creal(v), im[at] = cimag(v);
    }
}

static void store_terms(const workspace *w, int first, int count) {
  const modal_model *m = w->model, *i = w->imaginary, *b = w->backward;
  const int          nc = w->n_contact, q3 = w->to->probe.n;
  const int          contacts           = first + count <= nc ? count : nc > first ? nc - first : 0;
  const int          terms              = first + count <= w->n_term ? count : w->n_term - first;
  double            *contact[][2]       = {{m->residual_flexibility, i->residual_flexibility},
                                           {m->residual_inertia, i->residual_inertia},
                                           {m->residual_fourth, i->residual_fourth}};
  double            *probe_contact[][2] = {{m->probe_contact_residual, i->probe_contact_residual},
                                           {m->probe_contact_inertia, i->probe_contact_inertia},
                                           {m->probe_contact_fourth, i->probe_contact_fourth}};
  double complex    *load[][2]          = {{m->load_residual, b->load_residual},
                                           {m->load_inertia, b->load_inertia},
                                           {m->load_fourth, b->load_fourth}};
  double complex    *probe_load[][2]    = {{m->probe_load_residual, b->probe_load_residual},
                                           {m->probe_load_inertia, b->probe_load_inertia},
                                           {m->probe_load_fourth, b->probe_load_fourth}};
  for (int t = 0; t < BLOCKS; t++) {
    put_columns(w, w->sample[t], nc, first, contacts, contact[t][0], contact[t][1]);
    put_columns(w, w->probe[t], q3, first, contacts, probe_contact[t][0], probe_contact[t][1]);
    for (int c = contacts; c < terms; c++) {
      add_load(w, first + c - nc, nc, w->batch, w->sample[t] + c, load[t][0], load[t][1]);
      if (q3 > 0)
        add_load(w, first + c - nc, q3, w->batch, w->probe[t] + c, probe_load[t][0],
                 probe_load[t][1]);
    }
  }
}

/* ------------------------------------------------------------------ residual modes */

/* Residual modes at the columns and the probes. */
typedef struct {
  wave_ritz       ritz;
  double complex *psi, *at_probe; /* [columns][n], [probe dofs][n] */
  double         *size;           /* [columns][n] |psi| */
} ritz_shapes;

/* psi[rows][n] = sum_i sample_i weight_i */
static void form_shapes(const workspace *w, const wave_ritz *ritz, int rows,
                        double complex *const value[BLOCKS], double complex *psi) {
  const int b = w->batch, n = ritz->n;
  for (int i = 0; i < BLOCKS && rows > 0 && n > 0; i++)
    cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, rows, n, b, &one, value[i], b,
                ritz->weight + (size_t)i * (size_t)b * (size_t)n, n, i > 0 ? &one : &zero, psi, n);
}

/* Tail behind all residual modes. */
static void subtract_ritz_tails(workspace *w, const ritz_shapes *s) {
  static const double rounding = 1e-11;
  for (int c = 0; c < w->n_column; c++) {
    double a = w->tail[0][c], b = w->tail[1][c];
    for (int i = 0; i < s->ritz.n; i++) {
      const double shape = s->size[c * s->ritz.n + i];
      const double term  = shape * shape / pow(s->ritz.lambda[i], 2 * BLOCKS + 1);
      a -= term;
      b -= term / s->ritz.lambda[i];
    }
    w->tail[0][c] = fmax(a, rounding * w->tail[0][c]);
    w->tail[1][c] = fmax(b, 0);
  }
}

/* Number of residual modes that are needed; scale as in modal/condense/condense.c. */
static int count_needed(const workspace *w, const ritz_shapes *s) {
  const modal_residual_modes sizes = {.n = s->ritz.n, .lambda = s->ritz.lambda};
  const size_t               next  = (size_t)w->batch + 1;
  const double               last  = w->modes->lambda[w->modes->n - 1];
  double                     scale[MAX_COLUMNS], most = 0;
  for (int c = 0; c < w->n_contact; c++) most = fmax(most, creal(w->moment[0][(size_t)c * next]));
  for (int c = 0; c < w->n_column; c++)
    scale[c] = c < w->n_contact ? most : creal(w->moment[0][(size_t)c * next]);
  return modal_residual_modes_needed(&sizes, w->n_column, s->size, scale, last / 2, NEGLIGIBLE);
}

static void allocate_residual_modes(const workspace *w, int kept) {
  modal_model *m = w->model, *i = w->imaginary;
  const size_t r = (size_t)kept, nc = (size_t)w->n_contact, q3 = (size_t)w->to->probe.n;
  const size_t K              = (size_t)m->n_load + 1;
  m->n_residual               = kept;
  m->residual_frequency       = shb_alloc_zeroed(r + 1, sizeof(double));
  m->residual_shape           = shb_alloc_zeroed(nc * r + 1, sizeof(double));
  i->residual_shape           = shb_alloc_zeroed(nc * r + 1, sizeof(double));
  m->residual_probe           = shb_alloc_zeroed(q3 * r + 1, sizeof(double));
  i->residual_probe           = shb_alloc_zeroed(q3 * r + 1, sizeof(double));
  m->residual_force           = shb_alloc_zeroed(K * r + 1, sizeof(double complex));
  w->backward->residual_force = shb_alloc_zeroed(K * r + 1, sizeof(double complex));
}

static void store_residual_modes(const workspace *w, const ritz_shapes *s, int kept) {
  modal_model      *m = w->model, *im = w->imaginary;
  const modal_load *load = &w->to->load;
  const int         n = s->ritz.n, nc = w->n_contact;
  for (int i = 0; i < kept; i++) {
    m->residual_frequency[i] = sqrt(s->ritz.lambda[i]) / SHB_TWO_PI;
    for (int c = 0; c < nc; c++)
      split(1, s->psi + c * n + i, m->residual_shape + c * kept + i,
            im->residual_shape + c * kept + i);
    for (int c = 0; c < w->to->probe.n; c++)
      split(1, s->at_probe + c * n + i, m->residual_probe + c * kept + i,
            im->residual_probe + c * kept + i);
    for (int k = 0; k <= load->n_harmonics; k++)
      for (int c = 0; c < load->dofs.n; c++) {
        const double complex weight = load->weight[k * load->dofs.n + c];
        const double complex psi    = s->psi[(nc + c) * n + i];
        m->residual_force[k * kept + i] += weight * conj(psi);
        w->backward->residual_force[k * kept + i] += weight * psi;
      }
  }
}

static shb_status make_residual_modes(workspace *w, ritz_shapes *s) {
  SHB_TRY(wave_ritz_create(w->n_column, w->moment, &s->ritz));
  const size_t n = (size_t)s->ritz.n, columns = (size_t)w->n_column, q3 = (size_t)w->to->probe.n;
  if (n == 0) return SHB_OK;
  s->psi      = shb_alloc(columns * n + 1, sizeof *s->psi);
  s->at_probe = shb_alloc(q3 * n + 1, sizeof *s->at_probe);
  s->size     = shb_alloc(columns * n + 1, sizeof *s->size);
  form_shapes(w, &s->ritz, w->n_column, w->sample, s->psi);
  form_shapes(w, &s->ritz, w->to->probe.n, w->probe, s->at_probe);
  for (size_t i = 0; i < columns * n; i++) s->size[i] = cabs(s->psi[i]);
  subtract_ritz_tails(w, s);
  const int kept = count_needed(w, s);
  allocate_residual_modes(w, kept);
  store_residual_modes(w, s, kept);
  return SHB_OK;
}

static shb_status create_residual_modes(workspace *w) {
  ritz_shapes s      = {.psi = NULL};
  shb_status  status = make_residual_modes(w, &s);
  wave_ritz_free(&s.ritz);
  free(s.psi);
  free(s.at_probe);
  free(s.size);
  return status;
}

/* ------------------------------------------------------------------ together */

/* Residual modes need all columns in one batch. */
static bool fits_single_batch(const workspace *w, int n_column) {
  return n_column <= MAX_COLUMNS && n_column <= (double)MAX_NUMBERS / (3. * (double)w->op->order);
}

static void create_columns(workspace *w) {
  const int with_probes = w->to->contact.n + w->to->load.dofs.n + w->to->probe.n;
  w->n_contact          = w->to->contact.n;
  w->n_column = w->n_term = w->n_contact + w->to->load.dofs.n;
  modal_dofs_append(&w->column, &w->to->contact);
  modal_dofs_append(&w->column, &w->to->load.dofs);
  if (fits_single_batch(w, with_probes)) {
    w->n_column = with_probes;
    modal_dofs_append(&w->column, &w->to->probe);
  }
  for (int i = 0; i < 2; i++)
    w->tail[i] = shb_alloc_zeroed((size_t)w->n_column + 1, sizeof **w->tail);
}

static void create_batch(workspace *w, int batch) {
  const size_t b = (size_t)batch, size = b * w->op->order;
  w->batch = batch;
  w->X     = fem_large_alloc(size, sizeof *w->X);
  w->Y     = fem_large_alloc(size, sizeof *w->Y);
  w->MX    = fem_large_alloc(size, sizeof *w->MX);
  w->C     = shb_alloc(b * (size_t)w->modes->n, sizeof *w->C);
  for (int i = 0; i < BLOCKS; i++) {
    w->sample[i] = shb_alloc((size_t)w->n_column * b, sizeof **w->sample);
    w->probe[i]  = shb_alloc((size_t)w->to->probe.n * b + 1, sizeof **w->probe);
  }
  for (int i = 0; i < 2 * BLOCKS; i++) w->moment[i] = shb_alloc(b * b, sizeof **w->moment);
}

static void free_workspace(workspace *w) {
  free(w->X);
  free(w->Y);
  free(w->MX);
  free(w->C);
  for (int i = 0; i < BLOCKS; i++) {
    free(w->sample[i]);
    free(w->probe[i]);
  }
  for (int i = 0; i < 2 * BLOCKS; i++) free(w->moment[i]);
  free(w->tail[0]);
  free(w->tail[1]);
  modal_dofs_free(&w->column);
}

/* Make a term of the contact Hermitian: rounding differences go. */
static void symmetrise(double *re, double *im, size_t n) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j <= i; j++) {
      const size_t a = i * n + j, b = j * n + i;
      re[a] = re[b] = (re[a] + re[b]) / 2;
      im[a]         = (im[a] - im[b]) / 2;
      im[b]         = -im[a];
    }
}

static shb_status fill(workspace *w) {
  create_columns(w);
  SHB_TRY(fill_shapes(w));
  const int n = w->n_column, nc = w->n_contact;
  if (nc == 0) return SHB_OK;
  const bool single_batch = fits_single_batch(w, w->n_column);
  create_batch(w, single_batch || n < BATCH ? n : BATCH);
  for (int first = 0; first < n; first += w->batch) {
    const int count = n - first < w->batch ? n - first : w->batch;
    SHB_CHECK(!shb_interrupted(), SHB_INTERRUPTED, "interrupted");
    compute_chain(w, first, count, single_batch);
    store_terms(w, first, count);
  }
  modal_model *m = w->model, *i = w->imaginary;
  symmetrise(m->residual_flexibility, i->residual_flexibility, (size_t)nc);
  symmetrise(m->residual_inertia, i->residual_inertia, (size_t)nc);
  symmetrise(m->residual_fourth, i->residual_fourth, (size_t)nc);
  if (single_batch) SHB_TRY(create_residual_modes(w));
  modal_store_tails(single_batch ? 2 * BLOCKS : BLOCKS, w->n_contact, w->tail, &w->to->load,
                    w->model);
  return SHB_OK;
}

static bool load_is_real(const modal_load *load) {
  for (int i = 0; i < (load->n_harmonics + 1) * load->dofs.n; i++)
    if (cimag(load->weight[i]) != 0) return false;
  return true;
}

shb_status wave_condense(wave_operator *op, const wave_modes *modes, const modal_condensation *to,
                         modal_model *model, modal_model *imaginary, modal_model *backward) {
  workspace w = {.op        = op,
                 .modes     = modes,
                 .to        = to,
                 .model     = model,
                 .imaginary = imaginary,
                 .backward  = backward};
  memset(model, 0, sizeof *model);
  memset(imaginary, 0, sizeof *imaginary);
  memset(backward, 0, sizeof *backward);
  allocate(&w);
  const shb_status status = fill(&w);
  free_workspace(&w);
  if (op->is_real || load_is_real(&to->load)) modal_model_free(backward);
  if (op->is_real) modal_model_free(imaginary);
  return status;
}
