#include "mhb/structure/speed_model.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

/* Relative distance of eigenvalues that count as one; the least eigenvalue of a model, of the greatest. */
static const double SAME = 1e-12, LEAST = 1e-12;

/* The model's arrays <- those of an entry whose rows are turned. */
static void point(const mhb_speed_table *r, double *entry, double *turned, modal_model *model) {
  const int side = 3 * model->n_pairs, m = r->n_modes;
  double   *plain[MHB_SPEED_TABLE_UNROTATED];
  for (int i = 0; i < MHB_SPEED_TABLE_UNROTATED; i++)
    plain[i] = r->count[i] ? entry + r->plain[i] : NULL;
  mhb_speed_table_set_unrotated(model, plain);
  model->right = turned;
  model->left  = model->has_left ? turned + side * m : NULL;
  model->probe = turned + (model->has_left ? 2 : 1) * side * m;
}

static shb_status make_model(const mhb_speed_table *r, double *entry, double *turned,
                             modal_model *model) {
  const modal_model *given = r->given;
  *model                   = (modal_model){.n_modes        = r->n_modes,
                                           .n_pairs        = given->n_pairs,
                                           .n_probes       = given->n_probes,
                                           .n_load         = given->n_load,
                                           .n_interfaces   = given->n_interfaces,
                                           .interface_name = given->interface_name,
                                           .interface      = given->interface,
                                           .has_left       = given->has_left,
                                           .tail_order     = given->tail_order,
                                           .probe_name     = given->probe_name,
                                           .normal         = given->normal,
                                           .area           = given->area};
  size_t m                 = (size_t)r->n_modes;
  model->frequency         = calloc(m, sizeof(double));
  model->damping_ratio     = calloc(m, sizeof(double));
  model->modal_force       = calloc(((size_t)given->n_load + 1) * m, sizeof(double complex));
  point(r, entry, turned, model);
  SHB_CHECK(model->frequency && model->damping_ratio && model->modal_force, SHB_ERR_IO,
            "out of memory for %zu modes", m);
  return SHB_OK;
}

static void free_model(modal_model *model) {
  free(model->frequency);
  free(model->damping_ratio);
  free(model->modal_force);
}

shb_status mhb_speed_model_create(const mhb_speed_table *r, mhb_speed_model **out) {
  mhb_speed_model *a = calloc(1, sizeof *a);
  SHB_CHECK(a, SHB_ERR_IO, "out of memory");
  const size_t m = (size_t)r->n_modes, rows = (size_t)r->rows, n = (size_t)r->n;
  a->run_up = r;
  a->omega = a->slope_at = NAN;
  a->stiffness           = calloc(m * m, sizeof(double));
  a->damping             = calloc(m * m, sizeof(double));
  a->entry               = calloc(r->size, sizeof(double));
  a->d_entry             = calloc(r->size, sizeof(double));
  a->turned              = calloc(rows * m, sizeof(double));
  a->d_turned            = calloc(rows * m, sizeof(double));
  a->U                   = calloc(m * m, sizeof(double));
  a->weight              = calloc(n, sizeof(double));
  a->d_weight            = calloc(n, sizeof(double));
  a->work                = calloc(4 * m * m + 40 * m, sizeof(double));
  int ok = a->stiffness && a->damping && a->entry && a->d_entry && a->turned && a->d_turned &&
           a->U && a->weight && a->d_weight && a->work;
  shb_status status = ok ? make_model(r, a->entry, a->turned, &a->model) : SHB_ERR_IO;
  if (status == SHB_OK) status = make_model(r, a->d_entry, a->d_turned, &a->slope);
  if (status != SHB_OK) {
    mhb_speed_model_destroy(a);
    SHB_FAIL(SHB_ERR_IO, "out of memory for %zu modes", m);
  }
  *out = a;
  return SHB_OK;
}

void mhb_speed_model_destroy(mhb_speed_model *a) {
  if (!a) return;
  free_model(&a->model);
  free_model(&a->slope);
  double *part[] = {a->stiffness, a->damping, a->entry,  a->d_entry,  a->turned,
                    a->d_turned,  a->U,       a->weight, a->d_weight, a->work};
  for (size_t i = 0; i < sizeof part / sizeof *part; i++) free(part[i]);
  free(a);
}

/* out += sum_i weight_i table_i */
static void combine(const mhb_speed_table *r, const double *weight, double *out) {
  for (int i = 1; i < r->n; i++) /* the first is base itself */
    cblas_daxpy((int)r->size, weight[i], r->table + (size_t)i * r->size, 1, out, 1);
}

/* Rows of an entry times U, and the load of the model from them. */
static void turn(const mhb_speed_model *a, const double *entry, double *turned,
                 modal_model *model) {
  const int     m = a->run_up->n_modes, rows = a->run_up->rows, K = model->n_load + 1;
  const double *re = turned + (rows - 2 * K) * m, *im = re + K * m;
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, rows, m, m, 1, entry + 2 * m * m, m, a->U, m,
              0, turned, m);
  for (int i = 0; i < K * m; i++) model->modal_force[i] = CMPLX(re[i], im[i]);
}

/* out[m][m] = U^T X U, X symmetric; work: m^2 */
static void congruent(const mhb_speed_model *a, const double *X, double *work, double *out) {
  const int m = a->run_up->n_modes;
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, m, m, m, 1, a->U, m, X, m, 0, work, m);
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, m, m, m, 1, work, m, a->U, m, 0, out, m);
}

/* Rows of U <- eigenvectors of K[m][m], square[m] ascending. K is graded: by one-sided Jacobi on its Cholesky factor the low eigenvalues are
 * good to rounding of their own, not of the highest one (Demmel and Veselic 1992). work: 2 m^2 + 3 m + 6; 0: K is not positive definite. */
static int find_modes(int m, const double *K, double *work, double *square, double *U) {
  double *A = work, *V = A + m * m, *sigma = V + m * m, *rest = sigma + m;
  memcpy(A, K, (size_t)(m * m) * sizeof *A);
  if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'U', m, A, m) != 0) return 0;
  for (int j = 0; j < m; j++)
    for (int i = j + 1; i < m; i++) A[j * m + i] = 0;
  if (LAPACKE_dgesvj_work(LAPACK_COL_MAJOR, 'U', 'N', 'V', m, m, A, m, sigma, 0, V, m, rest,
                          2 * m + 6) != 0)
    return 0;
  for (int i = 0; i < m; i++) { /* falling */
    const int from = m - 1 - i;
    square[i]      = pow(rest[0] * sigma[from], 2);
    memcpy(U + i * m, V + from * m, (size_t)m * sizeof *U);
  }
  return 1;
}

void mhb_speed_model_set(mhb_speed_model *a, double omega) {
  const mhb_speed_table *r = a->run_up;
  const int              m = r->n_modes;
  if (a->omega == omega) return;
  const double speed  = mhb_speed_table_speed(r, omega);
  double      *square = a->work, *rest = a->work + m, *Z = rest + m * m;
  modal_spline_weights(&r->spline, speed * speed, a->weight, a->d_weight);
  memcpy(a->entry, r->base, r->size * sizeof *a->entry);
  combine(r, a->weight, a->entry);
  if (!find_modes(m, a->entry, rest, square, a->U)) { /* to say by how much it is not */
    memcpy(a->U, a->entry, (size_t)(m * m) * sizeof *a->U);
    LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'L', m, a->U, m, square, rest, 3 * m * m + 39 * m);
  }
  a->least = square[0];
  for (int i = 0; i < m; i++)
    a->model.frequency[i] = sqrt(fmax(square[i], LEAST * square[m - 1])) / SHB_TWO_PI;
  congruent(a, a->entry + m * m, rest, Z);
  for (int i = 0; i < m; i++) a->model.damping_ratio[i] = fmax(0, Z[i * (m + 1)]);
  turn(a, a->entry, a->turned, &a->model);
  a->omega = omega;
}

/* dN from dK, Z in the modes, and U^T Z' U. */
static void differentiate_damping(mhb_speed_model *a, const double *Z, const double *dZ) {
  const int     m    = a->run_up->n_modes;
  const double *zeta = a->model.damping_ratio, *dK = a->stiffness;
  for (int i = 0; i < m; i++) {
    const double w = SHB_TWO_PI * a->model.frequency[i];
    double       d = dZ[i * (m + 1)];
    for (int j = 0; j < m; j++) {
      const double v = SHB_TWO_PI * a->model.frequency[j], apart = w * w - v * v;
      const bool   same     = i == j || fabs(apart) <= SAME * w * w;
      const double steep    = same ? 0 : 2 * (zeta[i] - zeta[j]) * w / apart;
      a->damping[i * m + j] = dK[i * m + j] * (steep + 2 * zeta[j] / (w + v));
      if (!same) d += 2 * Z[i * m + j] * dK[i * m + j] / apart;
    }
    a->damping[i * (m + 1)] += 2 * w * d;
  }
}

void mhb_speed_model_differentiate(mhb_speed_model *a) {
  const mhb_speed_table *r = a->run_up;
  const int              m = r->n_modes;
  if (a->slope_at == a->omega) return;
  const double own = a->omega / r->engine_order, square = (double)r->engine_order * r->engine_order;
  const bool   inside = own >= r->low * (1 - SAME) && own <= r->high * (1 + SAME);
  double      *work = a->work, *Z = work + m * m, *dZ = Z + m * m;
  for (int i = 0; i < r->n; i++) a->d_weight[i] *= inside ? 2 * a->omega / square : 0;
  memset(a->d_entry, 0, r->size * sizeof *a->d_entry);
  combine(r, a->d_weight, a->d_entry);
  congruent(a, a->d_entry, work, a->stiffness);
  congruent(a, a->entry + m * m, work, Z);
  congruent(a, a->d_entry + m * m, work, dZ);
  differentiate_damping(a, Z, dZ);
  turn(a, a->d_entry, a->d_turned, &a->slope);
  a->slope_at = a->omega;
}

shb_status mhb_speed_model_check(const mhb_speed_table *table, const char *path) {
  enum { SAMPLES = 33 };
  mhb_speed_model *here  = NULL;
  double           least = INFINITY, speed = 0;
  SHB_TRY(mhb_speed_model_create(table, &here));
  for (int i = 0; i < SAMPLES; i++) {
    double omega = table->band[0] + (table->band[1] - table->band[0]) * i / (SAMPLES - 1);
    mhb_speed_model_set(here, omega);
    if (here->least >= least) continue;
    least = here->least;
    speed = mhb_speed_table_speed(table, omega);
  }
  mhb_speed_model_destroy(here);
  SHB_CHECK(least > 0, SHB_ERR_INPUT,
            "mhb.run_up: %s: the speeds are too far apart: interpolated to %.6g rpm the blade is "
            "not stable; give more speeds",
            path, speed * 60 / SHB_TWO_PI);
  return SHB_OK;
}
