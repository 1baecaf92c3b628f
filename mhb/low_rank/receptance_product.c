#include "mhb/low_rank/receptance_product.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/blas_room.h"
#include "mhb/numerics/random.h"

/* Singular values below it are left out, in the norm of the contact stiffness, where I is 1. */
static const double NEGLIGIBLE = 1e-12;

/* The same for a product of an iteration. */
static const double COARSE = 1e-6;

/* Columns of the first sketch, and of the largest one that may be the whole space. */
enum { FIRST_SKETCH = 128, MOST_WHOLE = 512 };

/* ---- the smooth part ---- */

/* Smooth term i of the receptance: even and odd coupling of each term, then self of the third. */
static const double *source_of(const mhb_receptance *r, int i) {
  mhb_cyclic_flexibility *const *f = r->residual_terms->contact;
  if (i == MHB_SMOOTH_TERMS - 1) return f[2] ? f[2]->self : NULL;
  if (!f[i / 2]) return NULL;
  return i % 2 ? f[i / 2]->odd_coupling : f[i / 2]->even_coupling;
}

/* The residual term whose weight smooth term i has. */
static int term_of(int i) {
  return i == MHB_SMOOTH_TERMS - 1 ? 2 : i / 2;
}

/* Factors of the axes in the norm of the contact stiffness, and what a sketch needs. */
typedef struct {
  const double *root;                     /* [n] of the stiffness */
  double        weight[MHB_SMOOTH_TERMS]; /* at the highest frequency */
  int           columns;
  double       *Q, *random, *image, *half; /* [n][columns] */
  double       *small;                     /* [columns][terms * columns] */
  double       *singular, *left, *work;
} sketch;

/* to += weight D^1/2 A D^1/2 from, D^1/2 = root; A of n columns. */
static void add_scaled(const sketch *s, int n, int columns, int term, const double *A,
                       const double *from, double *to) {
  for (int i = 0; i < n; i++)
    for (int j = 0; j < columns; j++) s->half[i * columns + j] = s->root[i] * from[i * columns + j];
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, columns, n, s->weight[term], A, n,
              s->half, columns, 0, s->image, columns);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < columns; j++) to[i * columns + j] += s->root[i] * s->image[i * columns + j];
}

static void sketch_free(sketch *s) {
  free(s->Q);
  free(s->random);
  free(s->image);
  free(s->half);
  free(s->small);
  free(s->singular);
  free(s->left);
  free(s->work);
}

static int sketch_allocate(sketch *s, int n) {
  size_t q = (size_t)s->columns, rows = (size_t)n;
  s->Q        = calloc(rows * q, sizeof(double));
  s->random   = calloc(rows * q, sizeof(double));
  s->image    = calloc(rows * q, sizeof(double));
  s->half     = calloc(rows * q, sizeof(double));
  s->small    = calloc(q * q * MHB_SMOOTH_TERMS, sizeof(double));
  s->singular = calloc(q, sizeof(double));
  s->left     = calloc(q * q, sizeof(double));
  s->work     = calloc(q * q * MHB_SMOOTH_TERMS, sizeof(double));
  return s->Q && s->random && s->image && s->half && s->small && s->singular && s->left && s->work;
}

/* Q <- orthonormal basis of the image of all smooth terms. */
static int find_range(const mhb_receptance_product *p, sketch *s) {
  int                n = p->n, q = s->columns;
  unsigned long long seed = 1;
  for (int t = 0; t < MHB_SMOOTH_TERMS; t++) {
    const double *A = source_of(p->receptance, t);
    if (!A) continue;
    for (int i = 0; i < n * q; i++) s->random[i] = 0.5 * mhb_random(&seed);
    add_scaled(s, n, q, t, A, s->random, s->Q);
  }
  return LAPACKE_dgeqrf(LAPACK_ROW_MAJOR, n, q, s->Q, q, s->singular) == 0 &&
         LAPACKE_dorgqr(LAPACK_ROW_MAJOR, n, q, q, s->Q, q, s->singular) == 0;
}

/* Singular vectors of [Q^T A_t Q ...] by all terms: s->left, columns in falling order. */
static int reduce(const mhb_receptance_product *p, sketch *s) {
  int n = p->n, q = s->columns, wide = MHB_SMOOTH_TERMS * q;
  for (int t = 0; t < MHB_SMOOTH_TERMS; t++) {
    const double *A = source_of(p->receptance, t);
    memset(s->random, 0, sizeof(double) * (size_t)n * (size_t)q);
    if (A) add_scaled(s, n, q, t, A, s->Q, s->random);
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, q, q, n, 1, s->Q, q, s->random, q, 0,
                s->small + t * q, wide);
  }
  memcpy(s->work, s->small, sizeof(double) * (size_t)q * (size_t)wide);
  double rest[q];
  return LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'S', 'N', q, wide, s->work, wide, s->singular, s->left, q,
                        NULL, wide, rest) == 0;
}

/* Largest element of (A - U U^+ A U U^+) x over a few random x, in the norm: what U leaves out. */
static double left_out(const mhb_receptance_product *p, sketch *s, int rank) {
  enum { PROBES = 4 };
  int                n = p->n, q = s->columns;
  unsigned long long seed = 77;
  double worst = 0, probe[PROBES * n], inside[PROBES * n], image[PROBES * n], small[PROBES * q],
         back[PROBES * q];
  for (int t = 0; t < MHB_SMOOTH_TERMS; t++) {
    const double *A = source_of(p->receptance, t);
    if (!A) continue;
    for (int i = 0; i < PROBES * n; i++) probe[i] = 0.5 * mhb_random(&seed);
    memset(image, 0, sizeof image);
    add_scaled(s, n, PROBES, t, A, probe, image);
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, q, PROBES, n, 1, s->Q, q, probe, PROBES, 0,
                small, PROBES);
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, rank, PROBES, q, 1, s->left, q, small,
                PROBES, 0, back, PROBES);
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, q, PROBES, rank, 1, s->left, q, back,
                PROBES, 0, small, PROBES);
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, PROBES, q, 1, s->Q, q, small, PROBES,
                0, probe, PROBES);
    memset(inside, 0, sizeof inside);
    add_scaled(s, n, PROBES, t, A, probe, inside);
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, q, PROBES, n, 1, s->Q, q, inside, PROBES,
                0, small, PROBES);
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, rank, PROBES, q, 1, s->left, q, small,
                PROBES, 0, back, PROBES);
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, q, PROBES, rank, 1, s->left, q, back,
                PROBES, 0, small, PROBES);
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, PROBES, q, -1, s->Q, q, small, PROBES,
                1, image, PROBES);
    for (int i = 0; i < PROBES * n; i++) worst = fmax(worst, fabs(image[i]));
  }
  return worst;
}

/* U = D^-1/2 Q left, and the smooth terms between its columns. */
static void take_smooth(mhb_receptance_product *p, const sketch *s, int rank) {
  int     n = p->n, q = s->columns, wide = MHB_SMOOTH_TERMS * q;
  double *half = s->work;
  p->n_smooth  = rank;
  p->U         = shb_arena_take(&p->arena, (size_t)n * (size_t)rank, sizeof(double));
  p->size      = shb_arena_take(&p->arena, (size_t)rank, sizeof(double));
  if (!p->U || !p->size) return;
  memcpy(p->size, s->singular, sizeof(double) * (size_t)rank);
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, rank, q, 1, s->Q, q, s->left, q, 0,
              p->U, rank);
  for (int i = 0; i < n; i++) cblas_dscal(rank, 1 / s->root[i], p->U + i * rank, 1);
  for (int t = 0; t < MHB_SMOOTH_TERMS; t++) {
    if (!source_of(p->receptance, t)) continue;
    double *to = shb_arena_take(&p->arena, (size_t)rank * (size_t)rank, sizeof(double));
    if (!to) return;
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, rank, q, q, 1 / s->weight[t], s->left, q,
                s->small + t * q, wide, 0, half, q);
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, rank, rank, q, 1, half, q, s->left, q, 0,
                to, rank);
    p->smooth[t] = to;
  }
}

/* Few columns matter to a product of an iteration, or few are left at all. */
static int saves(const sketch *s, int n, int rank) {
  return rank < n / 2 || s->singular[n / 2] < COARSE;
}

/* One sketch. 1: the smooth part is found; 0: more columns are needed; -1: failed. */
static int try_sketch(mhb_receptance_product *p, sketch *s) {
  if (!sketch_allocate(s, p->n) || !find_range(p, s) || !reduce(p, s)) return -1;
  int rank = 0;
  while (rank < s->columns && s->singular[rank] > NEGLIGIBLE) rank++;
  if (rank > s->columns - 16 && s->columns < p->n) return 0;
  if (left_out(p, s, rank) > 1e2 * NEGLIGIBLE || !saves(s, p->n, rank)) return -1;
  take_smooth(p, s, rank);
  return 1;
}

static void find_smooth(mhb_receptance_product *p, const double *stiffness, double top) {
  double       root[p->n];
  sketch       s      = {.root = root};
  modal_series series = modal_series_at(p->receptance->model, top);
  int          any = 0, found = 0;
  for (int i = 0; i < p->n; i++) root[i] = sqrt(stiffness[i]);
  for (int t = 0; t < MHB_SMOOTH_TERMS; t++) {
    s.weight[t] = fmax(series.weight[term_of(t)], 1e-300);
    any |= source_of(p->receptance, t) != NULL;
  }
  for (int q = FIRST_SKETCH; any && !found; q *= 2) {
    if (q >= p->n && p->n > MOST_WHOLE) break;
    s.columns = q < p->n ? q : p->n;
    found     = try_sketch(p, &s);
    sketch_free(&s);
    if (s.columns == p->n) break;
  }
  if (found == 1 || !any) return;
  p->U        = NULL; /* the terms themselves */
  p->n_smooth = p->n;
  for (int t = 0; t < MHB_SMOOTH_TERMS; t++) p->smooth[t] = (double *)source_of(p->receptance, t);
}

/* ---- life cycle ---- */

/* The size of own_t, at most the largest sum of a row, and its copy of single precision. */
static void take_own(mhb_receptance_product *p, int t, const double *stiffness) {
  const size_t n = (size_t)p->n;
  if (!p->own[t]) return;
  for (size_t i = 0; i < n; i++) {
    double sum = 0;
    for (size_t j = 0; j < n; j++)
      sum += sqrt(stiffness[i] * stiffness[j]) * fabs(p->own[t][i * n + j]);
    p->own_size[t] = fmax(p->own_size[t], sum);
  }
  p->coarse[t] = shb_arena_take(&p->arena, n * n, sizeof(float));
  for (size_t i = 0; p->coarse[t] && i < n * n; i++) p->coarse[t][i] = (float)p->own[t][i];
}

static void take_arrays(mhb_receptance_product *p) {
  size_t n = (size_t)p->n, K = (size_t)p->m + 1, nb = (size_t)p->nb, s = (size_t)p->n_smooth;
  for (int i = 0; i < MHB_PRODUCTS; i++)
    p->pole[i] = shb_arena_take(&p->arena, K * (size_t)p->n_poles, sizeof(double complex));
  p->weight        = shb_arena_take(&p->arena, K * MODAL_TERMS * MHB_PRODUCTS, sizeof(double));
  p->turned        = shb_arena_take(&p->arena, s * nb, sizeof(double));
  p->weighted      = shb_arena_take(&p->arena, n * nb, sizeof(double));
  p->coefficient   = shb_arena_take(&p->arena, s * nb, sizeof(double));
  p->response      = shb_arena_take(&p->arena, s * nb, sizeof(double));
  p->force         = shb_arena_take(&p->arena, n + MHB_BLAS_ROOM, sizeof(double complex));
  p->motion        = shb_arena_take(&p->arena, n, sizeof(double complex));
  p->coarse_force  = shb_arena_take(&p->arena, n * nb, sizeof(float));
  p->coarse_motion = shb_arena_take(&p->arena, n * nb, sizeof(float));
  p->amplitude =
      shb_arena_take(&p->arena, (size_t)p->n_poles + MHB_BLAS_ROOM, sizeof(double complex));
}

shb_status mhb_receptance_product_create(mhb_receptance *r, int first, int m,
                                         const double *stiffness, double top,
                                         mhb_receptance_product **out) {
  mhb_receptance_product *p = calloc(1, sizeof *p);
  SHB_CHECK(p, SHB_ERR_IO, "out of memory");
  p->receptance = r;
  p->n          = r->n;
  p->first      = first;
  p->m          = m;
  p->nb         = first ? 2 * (m - first + 1) : 2 * m + 1;
  p->n_poles    = r->n_modes + r->model->n_residual;
  p->omega      = NAN;
  for (int t = 0; t < 2; t++)
    p->own[t] = r->residual_terms->contact[t] ? r->residual_terms->contact[t]->self : NULL;
  for (int t = 0; t < 2; t++) take_own(p, t, stiffness);
  find_smooth(p, stiffness, m * top / r->nu);
  take_arrays(p);
  if (p->arena.failed) {
    mhb_receptance_product_destroy(p);
    SHB_FAIL(SHB_ERR_IO, "out of memory for the receptance of %d pairs", r->n / 3);
  }
  *out = p;
  return SHB_OK;
}

void mhb_receptance_product_destroy(mhb_receptance_product *p) {
  if (!p) return;
  shb_arena_free(&p->arena);
  free(p);
}

/* ---- at a frequency ---- */

/* Weights of a residual term in all harmonics. */
static double *weights_of(const mhb_receptance_product *p, mhb_product_kind kind, int term) {
  return p->weight + ((size_t)kind * MODAL_TERMS + (size_t)term) * ((size_t)p->m + 1);
}

/* L and dL/d omega of the modes, g and dg/d omega of the residual modes. */
static void set_poles(mhb_receptance_product *p, int k, const modal_series *series, double dw2) {
  const mhb_receptance *r     = p->receptance;
  double                kk    = (double)k / r->nu;
  double complex       *value = p->pole[MHB_PRODUCT_VALUE] + (size_t)k * (size_t)p->n_poles;
  double complex       *slope = p->pole[MHB_PRODUCT_SLOPE] + (size_t)k * (size_t)p->n_poles;
  for (int i = 0; i < r->n_modes; i++) {
    double complex L    = r->lambda[k * r->n_modes + i];
    double         loss = 2 * r->model->damping_ratio[i] * SHB_TWO_PI * r->model->frequency[i] * kk;
    value[i]            = L;
    slope[i]            = L * L * CMPLX(dw2, -loss);
  }
  for (int i = 0; i < r->model->n_residual; i++) {
    double dg, g = modal_series_mode(r->model, i, series, &dg);
    value[r->n_modes + i] = g;
    slope[r->n_modes + i] = dg * dw2;
  }
}

void mhb_receptance_product_update(mhb_receptance_product *p) {
  mhb_receptance *r = p->receptance;
  if (p->omega == r->omega) return;
  p->omega = r->omega;
  for (int k = p->first; k <= p->m; k++) {
    double       kk = (double)k / r->nu, dw2 = 2 * kk * kk * r->omega;
    modal_series series = modal_series_at(r->model, kk * r->omega);
    mhb_receptance_update_load(r, k);
    for (int t = 0; t < MODAL_TERMS; t++) {
      weights_of(p, MHB_PRODUCT_VALUE, t)[k] = series.weight[t];
      weights_of(p, MHB_PRODUCT_SLOPE, t)[k] = dw2 * series.slope[t];
    }
    set_poles(p, k, &series, dw2);
  }
}

/* Weight of column j of a force. */
static double column_weight(const mhb_receptance_product *p, const double *weight, int j) {
  return weight[p->first ? p->first + j / 2 : (j + 1) / 2];
}

/* out += own (weight p) in single precision. */
static void add_own_single(mhb_receptance_product *p, int t, const double *weight,
                           const double *force, double *out) {
  const int n = p->n, nb = p->nb;
  float    *from = p->coarse_force, *to = p->coarse_motion;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < nb; j++)
      from[i * nb + j] = (float)(column_weight(p, weight, j) * force[i * nb + j]);
  cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, nb, n, 1, p->coarse[t], n, from, nb, 0,
              to, nb);
  for (int i = 0; i < n * nb; i++) out[i] += to[i];
}

/* out += own (weight p) */
static void add_own(mhb_receptance_product *p, int t, mhb_product_kind kind, double negligible,
                    const double *force, double *out) {
  const double *weight = weights_of(p, kind, t), *from = force;
  int           n = p->n, nb = p->nb, plain = 1;
  double        most = 0;
  for (int k = p->first; k <= p->m; k++) {
    most = fmax(most, fabs(weight[k]));
    plain &= weight[k] == 1;
  }
  if (!p->own[t] || most == 0 || most * p->own_size[t] < negligible) return;
  if (p->coarse[t] && most * p->own_size[t] * FLT_EPSILON < negligible) {
    add_own_single(p, t, weight, force, out);
    return;
  }
  for (int i = 0; i < n && !plain; i++)
    for (int j = 0; j < nb; j++)
      p->weighted[i * nb + j] = column_weight(p, weight, j) * force[i * nb + j];
  if (!plain) from = p->weighted;
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, nb, n, 1, p->own[t], n, from, nb, 1,
              out, nb);
}

/* Columns of U that are larger than this. */
static int columns_above(const mhb_receptance_product *p, double negligible) {
  int count = p->n_smooth;
  while (p->U && count > 0 && p->size[count - 1] < negligible) count--;
  return count;
}

/* p->turned <- v[count][nb] with what smooth term t is multiplied by: the weight, times 1 (self),
 * - Re e_k (even) or - j Im e_k (odd). Returns 0 if that is nothing. */
static int turn(mhb_receptance_product *p, int t, mhb_product_kind kind, int count,
                const double *v) {
  const double *weight  = weights_of(p, kind, term_of(t));
  const int     is_self = t == MHB_SMOOTH_TERMS - 1, is_odd = !is_self && t % 2;
  int           any = 0, nb = p->nb;
  for (int k = p->first; k <= p->m; k++) {
    double complex e      = p->receptance->phase[k];
    double         factor = weight[k] * (is_self ? 1 : is_odd ? cimag(e) : -creal(e));
    int            re = mhb_product_column(p, k), im = re + 1;
    any |= factor != 0;
    for (int i = 0; i < count; i++) {
      const double *from = v + i * nb;
      double       *to   = p->turned + i * nb;
      to[re]             = factor * (is_odd ? (k ? from[im] : 0) : from[re]);
      if (k) to[im] = factor * (is_odd ? -from[re] : from[im]);
    }
  }
  return any;
}

/* out += U C_k U^T p_k */
static void add_smooth(mhb_receptance_product *p, mhb_product_kind kind, double negligible,
                       const double *force, double *out) {
  int           n = p->n, nb = p->nb, s = p->n_smooth, used = columns_above(p, negligible);
  const double *v = force;
  double       *y = out;
  if (used == 0) return;
  if (p->U) {
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, used, nb, n, 1, p->U, s, force, nb, 0,
                p->coefficient, nb);
    v = p->coefficient;
    y = p->response;
    memset(y, 0, sizeof(double) * (size_t)used * (size_t)nb);
  }
  for (int t = 0; t < MHB_SMOOTH_TERMS; t++)
    if (p->smooth[t] && turn(p, t, kind, used, v))
      cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, used, nb, used, 1, p->smooth[t], s,
                  p->turned, nb, 1, y, nb);
  if (p->U)
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, nb, used, 1, p->U, s, y, nb, 1, out,
                nb);
}

/* motion += X diag(pole) X^H force of harmonic k. */
static void add_shapes(mhb_receptance_product *p, int count, const double complex *X,
                       const double complex *pole) {
  const double complex one = 1, zero = 0;
  if (count == 0) return;
  cblas_zgemv(CblasRowMajor, CblasConjTrans, p->n, count, &one, X, count, p->force, 1, &zero,
              p->amplitude, 1);
  for (int i = 0; i < count; i++) p->amplitude[i] *= pole[i];
  cblas_zgemv(CblasRowMajor, CblasNoTrans, p->n, count, &one, X, count, p->amplitude, 1, &one,
              p->motion, 1);
}

static void add_poles(mhb_receptance_product *p, mhb_product_kind kind, const double *force,
                      double *out) {
  const mhb_receptance *r = p->receptance;
  int                   n = p->n, nb = p->nb, modes = r->n_modes, rest = r->model->n_residual;
  for (int k = p->first; k <= p->m; k++) {
    const double complex *pole = p->pole[kind] + (size_t)k * (size_t)p->n_poles;
    int                   any  = 0;
    for (int i = 0; i < n; i++) {
      const double *a = force + (size_t)i * (size_t)nb + mhb_product_column(p, k);
      p->force[i]     = k ? CMPLX(a[0], a[1]) : a[0];
      any |= creal(p->force[i]) != 0 || cimag(p->force[i]) != 0;
    }
    if (!any) continue;
    memset(p->motion, 0, sizeof(double complex) * (size_t)n);
    add_shapes(p, modes, r->B + (size_t)k * (size_t)n * (size_t)modes, pole);
    add_shapes(p, rest, r->residual_terms->S + (size_t)k * (size_t)n * (size_t)rest, pole + modes);
    for (int i = 0; i < n; i++) {
      double *to = out + (size_t)i * (size_t)nb + mhb_product_column(p, k);
      to[0] += creal(p->motion[i]);
      if (k) to[1] += cimag(p->motion[i]);
    }
  }
}

void mhb_receptance_product_apply(mhb_receptance_product *p, mhb_product_kind kind,
                                  double negligible, const double *force, double *out) {
  memset(out, 0, sizeof(double) * (size_t)p->n * (size_t)p->nb);
  for (int t = 0; t < 2; t++) add_own(p, t, kind, negligible, force, out);
  add_smooth(p, kind, negligible, force, out);
  add_poles(p, kind, force, out);
}
