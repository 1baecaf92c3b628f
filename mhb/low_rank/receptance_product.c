#include "mhb/low_rank/receptance_product.h"

#include <cblas.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/low_rank/smooth_span.h"
#include "mhb/numerics/blas_room.h"
#include "mhb/numerics/thin_product.h"

/* ---- the smooth part ---- */

/* The residual term whose weight smooth term i has. */
static int term_of(int i) {
  return i == MHB_SMOOTH_TERMS - 1 ? 2 : i / 2;
}

/* Smooth term i: C + C^T (even) and C - C^T (odd) of each residual term, then self of the third. */
static mhb_smooth_source source_of(const mhb_receptance *r, int i, double weight) {
  const mhb_cyclic_flexibility *f    = r->residual_terms->contact[term_of(i)];
  const int                     self = i == MHB_SMOOTH_TERMS - 1, odd = !self && i % 2;
  if (!f) return (mhb_smooth_source){NULL, weight, 0};
  if (self) return (mhb_smooth_source){f->self, weight, 0};
  return (mhb_smooth_source){f->coupling, weight, odd ? -1 : 1};
}

/* The terms themselves, where they have no small U. */
static void take_whole(mhb_receptance_product *p, int t, const mhb_smooth_source *source) {
  const size_t square = (size_t)p->n * (size_t)p->n;
  if (!source->A) return;
  p->smooth[t] = shb_arena_take(&p->arena, square, sizeof(double));
  if (!p->smooth[t]) return;
  if (source->sign)
    mhb_cyclic_flexibility_both(p->receptance->residual_terms->contact[term_of(t)], source->sign,
                                p->smooth[t]);
  else
    memcpy(p->smooth[t], source->A, sizeof(double) * square);
}

/* Largest weight of a residual term. */
static double weight_at(const mhb_receptance_product *p, int term, double top) {
  modal_series series = modal_series_at(p->receptance->model, top);
  return fmax(series.weight[term], 1e-300);
}

static void find_smooth(mhb_receptance_product *p, const double *root, double top) {
  mhb_smooth_source source[MHB_SMOOTH_TERMS];
  mhb_smooth_span   span;
  int               any = 0;
  for (int t = 0; t < MHB_SMOOTH_TERMS; t++) {
    source[t] = source_of(p->receptance, t, weight_at(p, term_of(t), top));
    any |= source[t].A != NULL;
  }
  mhb_smooth_span_find(p->n, root, MHB_SMOOTH_TERMS, source, &p->arena, &span);
  p->U    = span.U;
  p->size = span.size;
  if (!any) return;
  p->n_smooth = span.U ? span.rank : p->n; /* without U the terms themselves */
  for (int t = 0; t < MHB_SMOOTH_TERMS; t++)
    if (span.U)
      p->smooth[t] = span.C[t];
    else
      take_whole(p, t, &source[t]);
}

/* ---- the same of a disc ---- */

/* Matrix of a residual term at harmonic k, [n][n]. */
static const double complex *wave_term(const mhb_receptance_product *p, int t, int k) {
  const size_t square = (size_t)p->n * (size_t)p->n;
  return p->receptance->residual_terms->own[t] + (size_t)k * square;
}

/* What all harmonics have in common: the mean of the real parts. */
static void take_mean(mhb_receptance_product *p, int t) {
  const size_t square = (size_t)p->n * (size_t)p->n;
  double      *mean   = shb_arena_take(&p->arena, square, sizeof(double));
  for (int k = p->first; k <= p->m; k++)
    for (size_t i = 0; i < square; i++)
      mean[i] += creal(wave_term(p, t, k)[i]) / (p->m - p->first + 1);
  p->own[t] = mean;
}

/* part[2][n][n] <- real and imaginary part of a term without the mean. */
static void split_wave(const mhb_receptance_product *p, int t, int k, double *part) {
  const size_t          square = (size_t)p->n * (size_t)p->n;
  const double         *mean   = t < 2 ? p->own[t] : NULL;
  const double complex *from   = wave_term(p, t, k);
  for (size_t i = 0; i < square; i++) {
    part[i]          = creal(from[i]) - (mean ? mean[i] : 0);
    part[square + i] = cimag(from[i]);
  }
}

/* Term t of all harmonics between the columns of U, or whole. */
static void take_waves(mhb_receptance_product *p, int t, const mhb_smooth_span *span,
                       const double *part) {
  const size_t square = (size_t)p->n * (size_t)p->n, s = (size_t)p->n_smooth, K = (size_t)p->m + 1;
  p->wave[t] = shb_arena_take(&p->arena, K * s * s, sizeof(double complex));
  for (int k = p->first; k <= p->m; k++) {
    const size_t  at = 2 * ((size_t)t * K + (size_t)k);
    const double *re = span->U ? span->C[at] : part + at * square;
    const double *im = span->U ? span->C[at + 1] : re + square;
    for (size_t i = 0; i < s * s; i++) p->wave[t][(size_t)k * s * s + i] = CMPLX(re[i], im[i]);
  }
}

static void find_waves(mhb_receptance_product *p, const double *root, double top) {
  double complex *const *own    = p->receptance->residual_terms->own;
  const size_t           square = (size_t)p->n * (size_t)p->n, K = (size_t)p->m + 1;
  const int              n_sources = MODAL_TERMS * 2 * (p->m + 1);
  mhb_smooth_source     *source    = shb_alloc_zeroed((size_t)n_sources, sizeof *source);
  double                *part      = shb_alloc_zeroed((size_t)n_sources * square, sizeof *part);
  mhb_smooth_span        span      = {0};
  for (int t = 0; t < 2; t++)
    if (own[t]) take_mean(p, t);
  for (int t = 0; t < MODAL_TERMS; t++)
    for (int k = p->first; k <= p->m && own[t]; k++) {
      const size_t at = 2 * ((size_t)t * K + (size_t)k);
      split_wave(p, t, k, part + at * square);
      source[at]     = (mhb_smooth_source){part + at * square, weight_at(p, t, top), 0};
      source[at + 1] = (mhb_smooth_source){part + (at + 1) * square, source[at].weight, 0};
    }
  mhb_smooth_span_find(p->n, root, n_sources, source, &p->arena, &span);
  p->U        = span.U;
  p->size     = span.size;
  p->n_smooth = span.U ? span.rank : p->n;
  for (int t = 0; t < MODAL_TERMS; t++)
    if (own[t]) take_waves(p, t, &span, part);
  free(source);
  free(part);
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
  mhb_cyclic_flexibility *f = p->receptance->residual_terms->contact[t];
  if (f) { /* one copy serves all products */
    p->coarse[t] = mhb_cyclic_flexibility_single(f);
    return;
  }
  float *coarse = shb_arena_take(&p->arena, n * n, sizeof(float));
  for (size_t i = 0; i < n * n; i++) coarse[i] = (float)p->own[t][i];
  p->coarse[t] = coarse;
}

/* Numbers of a force in groups of columns. */
static size_t room_of(const mhb_receptance_product *p, int width) {
  return (size_t)p->n * (size_t)(width * mhb_thin_groups(p->nb, width));
}

static void take_arrays(mhb_receptance_product *p) {
  size_t n = (size_t)p->n, K = (size_t)p->m + 1, nb = (size_t)p->nb, s = (size_t)p->n_smooth;
  for (int i = 0; i < MHB_PRODUCTS; i++)
    p->pole[i] = shb_arena_take(&p->arena, K * (size_t)p->n_poles, sizeof(double complex));
  p->weight      = shb_arena_take(&p->arena, K * MODAL_TERMS * MHB_PRODUCTS, sizeof(double));
  p->turned      = shb_arena_take(&p->arena, s * nb, sizeof(double));
  p->coefficient = shb_arena_take(&p->arena, s * nb, sizeof(double));
  p->response    = shb_arena_take(&p->arena, s * nb, sizeof(double));
  p->force       = shb_arena_take(&p->arena, n + MHB_BLAS_ROOM, sizeof(double complex));
  p->motion      = shb_arena_take(&p->arena, n, sizeof(double complex));
  for (int i = 0; i < 2; i++)
    p->weighted[i] = shb_arena_take(&p->arena, room_of(p, MHB_THIN_COLUMNS), sizeof(double));
  p->coarse_force  = shb_arena_take(&p->arena, room_of(p, MHB_THIN_COLUMNS_SINGLE), sizeof(float));
  p->coarse_motion = shb_arena_take(&p->arena, room_of(p, MHB_THIN_COLUMNS_SINGLE), sizeof(float));
  p->wave_force    = shb_arena_take(&p->arena, s + MHB_BLAS_ROOM, sizeof(double complex));
  p->wave_motion   = shb_arena_take(&p->arena, s + MHB_BLAS_ROOM, sizeof(double complex));
  p->amplitude =
      shb_arena_take(&p->arena, (size_t)p->n_poles + MHB_BLAS_ROOM, sizeof(double complex));
}

mhb_receptance_product *mhb_receptance_product_create(mhb_receptance *r, int first, int m,
                                                      const double *stiffness, double top) {
  mhb_receptance_product *p = shb_alloc_zeroed(1, sizeof *p);
  p->receptance             = r;
  p->n                      = r->n;
  p->first                  = first;
  p->m                      = m;
  p->nb                     = first ? 2 * (m - first + 1) : 2 * m + 1;
  p->n_weights              = m + 1;
  p->n_poles                = r->n_modes + r->residual_terms->r;
  p->omega                  = NAN;
  double root[r->n];
  for (int i = 0; i < r->n; i++) root[i] = sqrt(stiffness[i]);
  for (int t = 0; t < 2; t++)
    if (r->residual_terms->contact[t]) p->own[t] = r->residual_terms->contact[t]->self;
  if (r->residual_terms->own[0])
    find_waves(p, root, m * top / r->nu);
  else
    find_smooth(p, root, m * top / r->nu);
  for (int t = 0; t < 2; t++) take_own(p, t, stiffness);
  take_arrays(p);
  return p;
}

void mhb_receptance_product_destroy(mhb_receptance_product *p) {
  if (!p) return;
  shb_arena_free(&p->arena);
  free(p);
}

/* ---- at a frequency ---- */

/* Weights of a residual term in all harmonics. */
static double *weights_of(const mhb_receptance_product *p, mhb_product_kind kind, int term) {
  return p->weight + ((size_t)kind * MODAL_TERMS + (size_t)term) * (size_t)p->n_weights;
}

/* L and dL/d omega of the modes unless they are coupled, g and dg/d omega of the residual modes. */
static void set_poles(mhb_receptance_product *p, int k, const modal_series *series, double dw2) {
  const mhb_receptance *r     = p->receptance;
  const modal_model    *model = mhb_receptance_model(r, k);
  double                kk    = (double)k / r->nu;
  double complex       *value = p->pole[MHB_PRODUCT_VALUE] + (size_t)k * (size_t)p->n_poles;
  double complex       *slope = p->pole[MHB_PRODUCT_SLOPE] + (size_t)k * (size_t)p->n_poles;
  for (int i = 0; i < r->n_modes && !r->factor; i++) {
    double complex L    = r->lambda[k * r->n_modes + i];
    double         loss = 2 * model->damping_ratio[i] * SHB_TWO_PI * model->frequency[i] * kk;
    value[i]            = L;
    slope[i]            = L * L * CMPLX(dw2, -loss);
  }
  for (int i = 0; i < model->n_residual; i++) {
    double dg, g = modal_series_mode(model, i, series, &dg);
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
    modal_series series = modal_series_at(mhb_receptance_model(r, k), kk * r->omega);
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

/* Place of row i, column j in groups of columns. */
static size_t place_in_groups(const mhb_receptance_product *p, int width, int i, int j) {
  return (size_t)(j / width * p->n + i) * (size_t)width + (size_t)(j % width);
}

/* out += own (weight p) in single precision. */
static void add_own_single(mhb_receptance_product *p, int t, const double *weight,
                           const double *force, double *out) {
  enum { WIDTH = MHB_THIN_COLUMNS_SINGLE };
  const int n = p->n, nb = p->nb;
  for (int j = 0; j < nb; j++) {
    const double by = column_weight(p, weight, j);
    for (int i = 0; i < n; i++)
      p->coarse_force[place_in_groups(p, WIDTH, i, j)] = (float)(by * force[i * nb + j]);
  }
  mhb_thin_product_single(n, mhb_thin_groups(nb, WIDTH), p->coarse[t], p->coarse_force,
                          p->coarse_motion);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < nb; j++)
      out[i * nb + j] += p->coarse_motion[place_in_groups(p, WIDTH, i, j)];
}

/* out += own (weight p) */
static void add_own(mhb_receptance_product *p, int t, mhb_product_kind kind, double negligible,
                    const double *force, double *out) {
  enum { WIDTH = MHB_THIN_COLUMNS };
  const double *weight = weights_of(p, kind, t);
  const int     n = p->n, nb = p->nb;
  double        most = 0;
  for (int k = p->first; k <= p->m; k++) most = fmax(most, fabs(weight[k]));
  if (!p->own[t] || most == 0 || most * p->own_size[t] < negligible) return;
  if (p->coarse[t] && most * p->own_size[t] * FLT_EPSILON < negligible) {
    add_own_single(p, t, weight, force, out);
    return;
  }
  for (int j = 0; j < nb; j++) {
    const double by = column_weight(p, weight, j);
    for (int i = 0; i < n; i++)
      p->weighted[0][place_in_groups(p, WIDTH, i, j)] = by * force[i * nb + j];
  }
  mhb_thin_product(n, mhb_thin_groups(nb, WIDTH), p->own[t], p->weighted[0], p->weighted[1]);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < nb; j++) out[i * nb + j] += p->weighted[1][place_in_groups(p, WIDTH, i, j)];
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

/* y[count][nb] += C_k v_k of a disc, v as the columns of U see the force. */
static void add_waves(mhb_receptance_product *p, mhb_product_kind kind, int count, const double *v,
                      double *y) {
  const double complex zero = 0;
  const size_t         s = (size_t)p->n_smooth, nb = (size_t)p->nb;
  for (int k = p->first; k <= p->m; k++) {
    const size_t at  = (size_t)mhb_product_column(p, k);
    int          any = 0;
    for (size_t i = 0; i < (size_t)count; i++)
      p->wave_force[i] = CMPLX(v[i * nb + at], k ? v[i * nb + at + 1] : 0);
    for (int t = 0; t < MODAL_TERMS; t++) {
      const double complex weight = weights_of(p, kind, t)[k], one = 1;
      if (!p->wave[t] || creal(weight) == 0) continue;
      cblas_zgemv(CblasRowMajor, CblasNoTrans, count, count, &weight,
                  p->wave[t] + (size_t)k * s * s, p->n_smooth, p->wave_force, 1, any ? &one : &zero,
                  p->wave_motion, 1);
      any = 1;
    }
    for (size_t i = 0; i < (size_t)count && any; i++) {
      y[i * nb + at] += creal(p->wave_motion[i]);
      if (k) y[i * nb + at + 1] += cimag(p->wave_motion[i]);
    }
  }
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
  add_waves(p, kind, used, v, y);
  if (p->U)
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, nb, used, 1, p->U, s, y, nb, 1, out,
                nb);
}

/* motion += X L X^H force of harmonic k; L = diag(pole), or that of coupled modes. */
static void add_shapes(mhb_receptance_product *p, int count, const double complex *X,
                       const double complex *pole, int k, mhb_product_kind kind) {
  const double complex one = 1, zero = 0;
  if (count == 0) return;
  cblas_zgemv(CblasRowMajor, CblasConjTrans, p->n, count, &one, X, count, p->force, 1, &zero,
              p->amplitude, 1);
  if (pole)
    for (int i = 0; i < count; i++) p->amplitude[i] *= pole[i];
  else if (kind == MHB_PRODUCT_VALUE)
    mhb_receptance_coupled(p->receptance, k, p->amplitude);
  else
    mhb_receptance_coupled_slope(p->receptance, k, p->amplitude);
  cblas_zgemv(CblasRowMajor, CblasNoTrans, p->n, count, &one, X, count, p->amplitude, 1, &one,
              p->motion, 1);
}

static void add_poles(mhb_receptance_product *p, mhb_product_kind kind, const double *force,
                      double *out) {
  const mhb_receptance *r = p->receptance;
  int                   n = p->n, nb = p->nb, modes = r->n_modes, rest = r->residual_terms->r;
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
    add_shapes(p, modes, r->B + (size_t)k * (size_t)n * (size_t)modes, r->factor ? NULL : pole, k,
               kind);
    add_shapes(p, rest, r->residual_terms->S + (size_t)k * (size_t)n * (size_t)rest, pole + modes,
               k, kind);
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

/* The product of one harmonic has one or two columns and the same arrays. */
void mhb_receptance_product_of_harmonic(const mhb_receptance_product *p, int k,
                                        const double complex *force, double complex *motion) {
  mhb_receptance_product one = *p;
  one.first = one.m = k;
  one.nb            = k ? 2 : 1;
  if (k) { /* real and imaginary part side by side */
    mhb_receptance_product_apply(&one, MHB_PRODUCT_VALUE, 0, (const double *)force,
                                 (double *)motion);
    return;
  }
  double re[p->n], out[p->n];
  for (int i = 0; i < p->n; i++) re[i] = creal(force[i]);
  mhb_receptance_product_apply(&one, MHB_PRODUCT_VALUE, 0, re, out);
  for (int i = 0; i < p->n; i++) motion[i] = out[i];
}
