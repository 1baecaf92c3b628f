#include "mhb/structure/equal_shapes.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/numerics/simd.h"
#include "mhb/structure/receptance.h"

static int n_all(const mhb_equal_shapes *e) {
  return e->modes + e->residual_modes;
}

static void set_shapes(mhb_equal_shapes *e, const mhb_receptance *blade) {
  const int     all = n_all(e), m = e->modes, r = e->residual_modes;
  const double *B = mhb_modal_part_split(blade->part, 0, 0);
  for (int a = 0; a < e->n; a++) {
    memcpy(e->shapes + a * all, B + a * m, sizeof(double) * (size_t)m);
    for (int j = 0; j < r; j++)
      e->shapes[a * all + m + j] = creal(blade->residual_terms->S[a * r + j]);
  }
  for (int i = 0; i < all; i++)
    for (int a = 0; a < e->n; a++)
      for (int b = 0; b < e->n; b++)
        e->outer[(size_t)i * (size_t)e->square + (size_t)(a * e->n + b)] =
            e->shapes[a * all + i] * e->shapes[b * all + i];
}

mhb_equal_shapes *mhb_equal_shapes_create(const mhb_receptance *blade) {
  mhb_equal_shapes *e = shb_alloc_zeroed(1, sizeof *e);
  e->n                = blade->n;
  e->modes            = blade->n_modes;
  e->residual_modes   = blade->residual_terms->r;
  e->square           = mhb_whole_lanes(e->n * e->n);
  const size_t all = (size_t)n_all(e), square = (size_t)e->square;
  const size_t r = (size_t)e->residual_modes, n = (size_t)e->n, real = sizeof(double);
  e->shapes = shb_arena_take(&e->arena, n * all, real);
  e->outer  = shb_arena_take(&e->arena, all * square, real);
  e->weight = shb_arena_take(&e->arena, r, real);
  e->slope  = shb_arena_take(&e->arena, r, real);
  for (int i = 0; i < 2; i++) {
    e->matrix[i] = shb_arena_take(&e->arena, square, real);
    e->drive[i]  = shb_arena_take(&e->arena, all, real);
  }
  set_shapes(e, blade);
  return e;
}

void mhb_equal_shapes_destroy(mhb_equal_shapes *e) {
  if (!e) return;
  shb_arena_free(&e->arena);
  free(e);
}

static double speed_of(const mhb_receptance *blade, int k) {
  return k * blade->omega / blade->nu;
}

/* The series of a blade, with the weights of its residual modes and their slopes. */
static modal_series set_weights(mhb_equal_shapes *e, const mhb_receptance *blade, double w) {
  const modal_model *model  = blade->model;
  const modal_series series = modal_series_at(model, w);
  modal_series_modes(model, &series, e->weight, e->slope);
  return series;
}

/* to[square] <- sum_i factor_i outer_i, or += it */
MHB_INLINE void sum_outer(int count, const double *factor, int square, const double *outer,
                          int adds, double *to) {
  for (int e = 0; e < square; e += MHB_LANES) {
    mhb_half_lanes sum[2] = {{0}};
    for (int j = 0; j < 2 && adds; j++) sum[j] = half_lanes_load(to + e + j * MHB_HALF_LANES);
    for (int i = 0; i < count; i++)
      for (int j = 0; j < 2; j++)
        sum[j] += factor[i] *
                  half_lanes_load(outer + (size_t)i * (size_t)square + e + j * MHB_HALF_LANES);
    for (int j = 0; j < 2; j++) half_lanes_store(to + e + j * MHB_HALF_LANES, sum[j]);
  }
}

MHB_HOT static void sum_modes(const mhb_equal_shapes *e, const double complex *lambda) {
  const int m = e->modes, r = e->residual_modes, square = e->square;
  for (int i = 0; i < m; i++) {
    e->drive[0][i] = creal(lambda[i]);
    e->drive[1][i] = cimag(lambda[i]);
  }
  sum_outer(m, e->drive[0], square, e->outer, 0, e->matrix[0]);
  sum_outer(m, e->drive[1], square, e->outer, 0, e->matrix[1]);
  sum_outer(r, e->weight, square, e->outer + (size_t)m * (size_t)square, 1, e->matrix[0]);
}

void mhb_equal_shapes_receptance(mhb_equal_shapes *e, const mhb_receptance *blade, int k) {
  const modal_series series = set_weights(e, blade, speed_of(blade, k));
  sum_modes(e, blade->lambda + k * e->modes);
  for (int t = 0; t < MODAL_TERMS; t++) {
    const mhb_cyclic_flexibility *term = blade->residual_terms->contact[t];
    const double                  a    = series.weight[t];
    for (int i = 0; term && a != 0 && i < e->n * e->n; i++) e->matrix[0][i] += a * term->self[i];
  }
}

/* drive <- -shapes^T p, by modes */
MHB_HOT static void project(const mhb_equal_shapes *e, const double complex *p, double *restrict re,
                            double *restrict im) {
  const int     all = n_all(e);
  const double *B   = e->shapes;
  memset(re, 0, sizeof(double) * (size_t)all);
  memset(im, 0, sizeof(double) * (size_t)all);
  for (int a = 0; p && a < e->n; a++, B += all) {
    const double pr = creal(p[a]), pi = cimag(p[a]);
    for (int i = 0; i < all; i++) {
      re[i] -= B[i] * pr;
      im[i] -= B[i] * pi;
    }
  }
}

/* drive of the modes times dL/d omega = L^2 (2 k^2 omega - 2 j zeta w_i k). */
MHB_HOT static void by_lambda(const mhb_receptance *blade, int k, double *restrict re,
                              double *restrict im) {
  const modal_model    *model  = blade->model;
  const double complex *lambda = blade->lambda + k * blade->n_modes;
  const double          kk = (double)k / blade->nu, spring = 2 * kk * kk * blade->omega;
  for (int i = 0; i < blade->n_modes; i++) {
    const double a = creal(lambda[i]), b = cimag(lambda[i]), sr = a * a - b * b, si = 2 * a * b;
    const double loss = -2 * SHB_TWO_PI * model->damping_ratio[i] * model->frequency[i] * kk;
    const double dr = sr * spring - si * loss, di = si * spring + sr * loss, x = re[i];
    re[i] = dr * x - di * im[i];
    im[i] = dr * im[i] + di * x;
  }
}

/* out[n] <- shapes drive */
MHB_HOT static void expand(const mhb_equal_shapes *e, double complex *out) {
  const int     all = n_all(e);
  const double *B = e->shapes, *yr = e->drive[0], *yi = e->drive[1];
  for (int a = 0; a < e->n; a++, B += all) {
    double re = 0, im = 0;
#pragma omp simd reduction(+ : re, im)
    for (int i = 0; i < all; i++) {
      re += B[i] * yr[i];
      im += B[i] * yi[i];
    }
    out[a] = CMPLX(re, im);
  }
}

/* out[n] += dw2 (scale a'_t x_t - a'_t M_t p) */
static void add_terms(const mhb_equal_shapes *e, const mhb_receptance *blade, int k,
                      const modal_series *series, double dw2, const double complex *p,
                      double complex *out) {
  const mhb_residual_terms *terms = blade->residual_terms;
  const int                 n     = e->n;
  for (int t = 0; t < MODAL_TERMS; t++) {
    const double a = dw2 * series->slope[t], load = dw2 * blade->scale * series->load_slope[t];
    for (int i = 0; terms->load[t] && blade->driven[k] && i < n; i++)
      out[i] += load * terms->load[t][k * n + i];
    if (!p || !terms->contact[t] || a == 0) continue;
    const double *M = terms->contact[t]->self;
    for (int i = 0; i < n; i++, M += n) {
      double re = 0, im = 0;
      for (int j = 0; j < n; j++) {
        re += M[j] * creal(p[j]);
        im += M[j] * cimag(p[j]);
      }
      out[i] -= CMPLX(a * re, a * im);
    }
  }
}

void mhb_equal_shapes_slope(mhb_equal_shapes *e, const mhb_receptance *blade, int k,
                            const double complex *p, double complex *out) {
  const int             m = e->modes, r = e->residual_modes;
  const double          kk = (double)k / blade->nu, dw2 = 2 * kk * kk * blade->omega;
  const modal_series    series = set_weights(e, blade, speed_of(blade, k));
  const double complex *F = blade->F + k * m, *residual = blade->residual_terms->F + k * r;
  double               *re = e->drive[0], *im = e->drive[1];
  project(e, p, re, im);
  for (int i = 0; blade->driven[k] && i < m + r; i++) {
    const double complex f = i < m ? F[i] : residual[i - m];
    re[i] += blade->scale * creal(f);
    im[i] += blade->scale * cimag(f);
  }
  by_lambda(blade, k, re, im);
  for (int j = 0; j < r; j++) {
    re[m + j] *= dw2 * e->slope[j];
    im[m + j] *= dw2 * e->slope[j];
  }
  expand(e, out);
  add_terms(e, blade, k, &series, dw2, p, out);
}
