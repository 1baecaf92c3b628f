#include "mhb/structure/speed_model.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

/* Relative distance of eigenvalues that count as equal; least eigenvalue of a model, relative to
 * the greatest. */
static const double SAME = 1e-12, LEAST = 1e-12;

/* The model's arrays <- those of an entry and its rotated shapes. */
static void point(const mhb_speed_table *r, double *coefficients, double *rotated,
                  modal_model *model) {
  const int side = 3 * model->n_pairs, m = r->n_modes;
  double   *unrotated[MHB_SPEED_TABLE_UNROTATED];
  for (int i = 0; i < MHB_SPEED_TABLE_UNROTATED; i++)
    unrotated[i] = r->count[i] ? coefficients + r->unrotated[i] : NULL;
  mhb_speed_table_set_unrotated(model, unrotated);
  model->right = rotated;
  model->left  = model->has_left ? rotated + side * m : NULL;
  model->probe = rotated + (model->has_left ? 2 : 1) * side * m;
}

static void make_model(mhb_speed_model *a, double *coefficients, double *rotated,
                       modal_model *model) {
  const modal_model *common = a->table->common;
  const size_t       m = (size_t)a->table->n_modes, K = (size_t)common->n_load + 1;
  *model               = (modal_model){.n_modes        = a->table->n_modes,
                                       .n_pairs        = common->n_pairs,
                                       .n_probes       = common->n_probes,
                                       .n_load         = common->n_load,
                                       .n_interfaces   = common->n_interfaces,
                                       .interface_name = common->interface_name,
                                       .interface      = common->interface,
                                       .has_left       = common->has_left,
                                       .tail_order     = common->tail_order,
                                       .probe_name     = common->probe_name,
                                       .normal         = common->normal,
                                       .area           = common->area};
  model->frequency     = shb_arena_take(&a->arena, m, sizeof(double));
  model->damping_ratio = shb_arena_take(&a->arena, m, sizeof(double));
  model->modal_force   = shb_arena_take(&a->arena, K * m, sizeof(double complex));
  if (!a->arena.failed) point(a->table, coefficients, rotated, model);
}

shb_status mhb_speed_model_create(const mhb_speed_table *table, mhb_speed_model **out) {
  mhb_speed_model *a = calloc(1, sizeof *a);
  SHB_CHECK(a, SHB_ERR_IO, "out of memory");
  const size_t m = (size_t)table->n_modes, shapes = (size_t)table->rows * m, real = sizeof(double);
  a->table = table;
  a->omega = a->slope_omega = NAN;
  a->stiffness              = shb_arena_take(&a->arena, m * m, real);
  a->damping                = shb_arena_take(&a->arena, m * m, real);
  a->coefficients           = shb_arena_take(&a->arena, table->size, real);
  a->d_coefficients         = shb_arena_take(&a->arena, table->size, real);
  a->rotated_shapes         = shb_arena_take(&a->arena, shapes, real);
  a->d_rotated_shapes       = shb_arena_take(&a->arena, shapes, real);
  a->U                      = shb_arena_take(&a->arena, m * m, real);
  a->weight                 = shb_arena_take(&a->arena, (size_t)table->n, real);
  a->d_weight               = shb_arena_take(&a->arena, (size_t)table->n, real);
  a->work                   = shb_arena_take(&a->arena, 4 * m * m + 40 * m, real);
  make_model(a, a->coefficients, a->rotated_shapes, &a->model);
  make_model(a, a->d_coefficients, a->d_rotated_shapes, &a->slope);
  if (a->arena.failed) {
    mhb_speed_model_destroy(a);
    SHB_FAIL(SHB_ERR_IO, "out of memory for %zu modes", m);
  }
  *out = a;
  return SHB_OK;
}

void mhb_speed_model_destroy(mhb_speed_model *a) {
  if (!a) return;
  shb_arena_free(&a->arena);
  free(a);
}

/* out += sum_i weight_i table_i */
static void combine(const mhb_speed_table *r, const double *weight, double *out) {
  for (int i = 1; i < r->n; i++) /* the differences of the first entry are 0 */
    cblas_daxpy((int)r->size, weight[i], r->entries + (size_t)i * r->size, 1, out, 1);
}

/* rotated <- rows of an entry times U, and the load of the model from them. */
static void rotate(const mhb_speed_model *a, const double *coefficients, double *rotated,
                   modal_model *model) {
  const int     m = a->table->n_modes, rows = a->table->rows, K = model->n_load + 1;
  const double *re = rotated + (rows - 2 * K) * m, *im = re + K * m;
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, rows, m, m, 1, coefficients + 2 * m * m, m,
              a->U, m, 0, rotated, m);
  for (int i = 0; i < K * m; i++) model->modal_force[i] = CMPLX(re[i], im[i]);
}

/* out[m][m] = U^T X U, X symmetric; work: m^2 */
static void congruent(const mhb_speed_model *a, const double *X, double *work, double *out) {
  const int m = a->table->n_modes;
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, m, m, m, 1, a->U, m, X, m, 0, work, m);
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, m, m, m, 1, work, m, a->U, m, 0, out, m);
}

/* Rows of U <- eigenvectors of K[m][m], square[m] <- eigenvalues, ascending. 0: K is not positive
 * definite. work: 2 m^2 + 3 m + 6.
 *
 * The entries of K differ by orders of magnitude. One-sided Jacobi on its Cholesky factor gives the
 * low eigenvalues to their own rounding, not to that of the highest (Demmel and Veselic 1992). */
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
  const mhb_speed_table *r = a->table;
  const int              m = r->n_modes;
  if (a->omega == omega) return;
  const double speed  = mhb_speed_table_speed(r, omega);
  double      *square = a->work, *rest = a->work + m, *Z = rest + m * m;
  modal_spline_weights(&r->spline, speed * speed, a->weight, a->d_weight);
  memcpy(a->coefficients, r->first_entry, r->size * sizeof *a->coefficients);
  combine(r, a->weight, a->coefficients);
  if (!find_modes(m, a->coefficients, rest, square,
                  a->U)) { /* the eigenvalues, to report by how much */
    memcpy(a->U, a->coefficients, (size_t)(m * m) * sizeof *a->U);
    LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'L', m, a->U, m, square, rest, 3 * m * m + 39 * m);
  }
  a->least_eigenvalue = square[0];
  for (int i = 0; i < m; i++)
    a->model.frequency[i] = sqrt(fmax(square[i], LEAST * square[m - 1])) / SHB_TWO_PI;
  congruent(a, a->coefficients + m * m, rest, Z);
  for (int i = 0; i < m; i++) a->model.damping_ratio[i] = fmax(0, Z[i * (m + 1)]);
  rotate(a, a->coefficients, a->rotated_shapes, &a->model);
  a->omega = omega;
}

/* damping <- dN, from dK, Z in the modes, and U^T Z' U. */
static void differentiate_damping(mhb_speed_model *a, const double *Z, const double *dZ) {
  const int     m    = a->table->n_modes;
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
  const mhb_speed_table *r = a->table;
  const int              m = r->n_modes;
  if (a->slope_omega == a->omega) return;
  const double own = a->omega / r->engine_order, square = (double)r->engine_order * r->engine_order;
  const bool   inside = own >= r->low * (1 - SAME) && own <= r->high * (1 + SAME);
  double      *work = a->work, *Z = work + m * m, *dZ = Z + m * m;
  for (int i = 0; i < r->n; i++) a->d_weight[i] *= inside ? 2 * a->omega / square : 0;
  memset(a->d_coefficients, 0, r->size * sizeof *a->d_coefficients);
  combine(r, a->d_weight, a->d_coefficients);
  congruent(a, a->d_coefficients, work, a->stiffness);
  congruent(a, a->coefficients + m * m, work, Z);
  congruent(a, a->d_coefficients + m * m, work, dZ);
  differentiate_damping(a, Z, dZ);
  rotate(a, a->d_coefficients, a->d_rotated_shapes, &a->slope);
  a->slope_omega = a->omega;
}

shb_status mhb_speed_model_check(const mhb_speed_table *table, const char *path) {
  enum { SAMPLES = 33 };
  mhb_speed_model *here  = NULL;
  double           least = INFINITY, speed = 0;
  SHB_TRY(mhb_speed_model_create(table, &here));
  for (int i = 0; i < SAMPLES; i++) {
    double omega = table->band[0] + (table->band[1] - table->band[0]) * i / (SAMPLES - 1);
    mhb_speed_model_set(here, omega);
    if (here->least_eigenvalue >= least) continue;
    least = here->least_eigenvalue;
    speed = mhb_speed_table_speed(table, omega);
  }
  mhb_speed_model_destroy(here);
  SHB_CHECK(least > 0, SHB_ERR_INPUT,
            "mhb.run_up: %s: the speeds are too far apart: interpolated to %.6g rpm the blade is "
            "not stable; give more speeds",
            path, speed * 60 / SHB_TWO_PI);
  return SHB_OK;
}
