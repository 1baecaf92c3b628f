#include "mhb/structure/residual_terms.h"

#include <cblas.h>
#include <stdlib.h>

#include "mesh/base/memory.h"
#include "mhb/numerics/simd.h"

static int n_contact(const modal_model *model) {
  return 3 * model->n_pairs * (model->has_left ? 2 : 1);
}

/* ---- independent of the frequency ---- */

typedef struct {
  const double         *contact[MODAL_TERMS], *probe_contact[MODAL_TERMS];
  const double complex *load[MODAL_TERMS], *probe_load[MODAL_TERMS];
} terms;

static terms terms_of(const modal_model *m, const modal_model *loads) {
  return (terms){{m->residual_flexibility, m->residual_inertia,
                  modal_series_has_fourth(m) ? m->residual_fourth : NULL},
                 {m->probe_contact_residual, m->probe_contact_inertia, m->probe_contact_fourth},
                 {loads->load_residual, loads->load_inertia, loads->load_fourth},
                 {loads->probe_load_residual, loads->probe_load_inertia, loads->probe_load_fourth}};
}

/* Imaginary parts of the terms of a wave. */
static terms imaginary_of(const modal_wave *wave) {
  const modal_model *m = wave->imaginary;
  if (!m) return (terms){.contact = {NULL}};
  return (terms){.contact = {m->residual_flexibility, m->residual_inertia, m->residual_fourth},
                 .probe_contact = {m->probe_contact_residual, m->probe_contact_inertia,
                                   m->probe_contact_fourth}};
}

/* NULL if there is nothing to hold. */
static double complex *array(mhb_residual_terms *l, const void *wanted, size_t n) {
  return wanted && n ? shb_arena_take(&l->arena, n, sizeof(double complex)) : NULL;
}

static void take_arrays(mhb_residual_terms *l, const terms *from, bool own) {
  const size_t n = (size_t)l->relative.n, K = (size_t)l->n_harmonics + 1;
  const size_t q = 3 * (size_t)l->model->n_probes, r = (size_t)l->r;
  for (int t = 0; t < MODAL_TERMS; t++) {
    if (own) l->own[t] = array(l, from->contact[t], K * n * n);
    l->load[t]          = array(l, from->load[t], K * n);
    l->probe_load[t]    = array(l, from->probe_load[t], K * q);
    l->probe_contact[t] = array(l, from->probe_contact[t], K * q * n);
  }
  l->S  = array(l, l, K * n * r);
  l->F  = array(l, l, K * r);
  l->Sg = array(l, l, n * r);
}

/* S = T times the residual modes. */
static void set_shapes(mhb_residual_terms *l, int k) {
  const modal_wave *wave = &l->wave[k];
  const double     *im   = wave->imaginary ? wave->imaginary->residual_shape : NULL;
  const size_t      n = (size_t)l->relative.n, r = (size_t)l->r;
  const size_t      here = (size_t)wave->model->n_residual;
  const int         nc   = n_contact(l->model);
  double complex   *S    = l->S + (size_t)k * n * r, column[nc];
  for (size_t i = 0; i < here; i++) {
    for (int c = 0; c < nc; c++)
      column[c] = modal_wave_value(wave, wave->model->residual_shape, im, (size_t)c * here + i);
    mhb_relative_motion(&l->relative, l->phase[k], column, 1, S + i, (int)r);
  }
}

/* T M T^H of one harmonic, M complex. */
static void set_own(mhb_residual_terms *l, int k, const double *matrix, const double *im,
                    double complex *out) {
  const int      n = l->relative.n, nc = n_contact(l->model);
  double complex column[nc], row[n];
  for (int a = 0; a < n; a++) {
    for (int j = 0; j < nc; j++) { /* row a of T M */
      double complex sum = 0;
      for (int side = 0; side < l->relative.sides; side++)
        for (int axis = 0; axis < 3; axis++) {
          const size_t c = (size_t)side * (size_t)n + (size_t)(a / 3 * 3 + axis);
          sum += mhb_relative_weight(&l->relative, a, side, axis, l->phase[k]) *
                 modal_wave_value(&l->wave[k], matrix, im, c * (size_t)nc + (size_t)j);
        }
      column[j] = conj(sum);
    }
    mhb_relative_motion(&l->relative, l->phase[k], column, 1, row, 1);
    for (int b = 0; b < n; b++)
      out[((size_t)k * (size_t)n + (size_t)a) * (size_t)n + (size_t)b] = conj(row[b]);
  }
}

/* Load harmonic h drives harmonic nu h. */
static void set_load(mhb_residual_terms *l, int k, const terms *from) {
  const modal_wave *wave = &l->wave[k];
  const int         h = k / l->nu, q = 3 * wave->model->n_probes, here = wave->model->n_residual;
  if (k % l->nu || h > wave->model->n_load) return;
  for (int i = 0; i < here; i++) l->F[k * l->r + i] = wave->loads->residual_force[h * here + i];
  for (int t = 0; t < MODAL_TERMS; t++) {
    if (l->load[t])
      mhb_relative_motion(&l->relative, l->phase[k], from->load[t] + h * n_contact(l->model), 1,
                          l->load[t] + k * l->relative.n, 1);
    for (int i = 0; l->probe_load[t] && i < q; i++)
      l->probe_load[t][k * q + i] = from->probe_load[t][h * q + i];
  }
}

/* Probe motion per contact force p: a residual matrix M [3 q][nc] times T^H. */
static void set_probe(const mhb_residual_terms *l, int k, const double *matrix, const double *im,
                      double complex *out) {
  const int      q = 3 * l->model->n_probes, nc = n_contact(l->model), n = l->relative.n;
  double complex column[nc];
  for (int i = 0; i < q; i++) {
    double complex *row = out + ((size_t)k * (size_t)q + (size_t)i) * (size_t)n;
    for (int j = 0; j < nc; j++)
      column[j] =
          conj(modal_wave_value(&l->wave[k], matrix, im, (size_t)i * (size_t)nc + (size_t)j));
    mhb_relative_motion(&l->relative, l->phase[k], column, 1, row, 1);
    for (int j = 0; j < n; j++) row[j] = conj(row[j]);
  }
}

static void set_harmonic(mhb_residual_terms *l, int k) {
  const modal_wave *wave = &l->wave[k];
  const terms       from = terms_of(wave->model, wave->loads), im = imaginary_of(wave);
  if (l->S) set_shapes(l, k);
  set_load(l, k, &from);
  for (int t = 0; t < MODAL_TERMS; t++) {
    if (l->own[t]) set_own(l, k, from.contact[t], im.contact[t], l->own[t]);
    if (l->probe_contact[t])
      set_probe(l, k, from.probe_contact[t], im.probe_contact[t], l->probe_contact[t]);
  }
}

void mhb_residual_terms_update(mhb_residual_terms *l) {
  const terms from = terms_of(l->model, l->model);
  for (int t = 0; t < MODAL_TERMS; t++)
    if (l->contact[t] && !l->borrowed)
      mhb_cyclic_flexibility_set(l->contact[t], from.contact[t], n_contact(l->model),
                                 l->relative.T0);
  for (int k = 0; k <= l->n_harmonics; k++) set_harmonic(l, k);
}

static shb_status make(mhb_residual_terms *l, const mhb_residual_terms *like, bool own) {
  const terms from = terms_of(l->model, l->model);
  SHB_CHECK(like || !l->model->residual_diagonal, SHB_ERR_INPUT,
            "the model has released its residual matrices, and no receptance with the same axes of "
            "the pairs lends them");
  take_arrays(l, &from, own);
  l->borrowed = like != NULL;
  for (int t = 0; t < MODAL_TERMS && like; t++) l->contact[t] = like->contact[t];
  for (int t = 0; t < MODAL_TERMS && !like && !own; t++)
    if (from.contact[t])
      l->contact[t] =
          mhb_cyclic_flexibility_create(from.contact[t], n_contact(l->model), l->relative.T0,
                                        l->model->n_pairs, l->relative.sides);
  mhb_residual_terms_update(l);
  return SHB_OK;
}

shb_status mhb_residual_terms_create(const modal_model *model, mhb_relative relative,
                                     const mhb_harmonics *harmonics, mhb_residual_terms **out) {
  mhb_residual_terms *l = shb_alloc_zeroed(1, sizeof *l);
  l->model              = model;
  l->relative           = relative;
  l->nu                 = harmonics->nu;
  l->n_harmonics        = harmonics->n_harmonics;
  l->phase              = harmonics->phase;
  l->wave               = harmonics->wave;
  for (int k = 0; k <= l->n_harmonics; k++)
    if (l->wave[k].model->n_residual > l->r) l->r = l->wave[k].model->n_residual;
  shb_status status = make(l, harmonics->like, harmonics->nodal_diameters);
  if (status == SHB_OK)
    *out = l;
  else
    mhb_residual_terms_destroy(l);
  return status;
}

void mhb_residual_terms_destroy(mhb_residual_terms *l) {
  if (!l) return;
  for (int t = 0; t < MODAL_TERMS && !l->borrowed; t++)
    mhb_cyclic_flexibility_destroy(l->contact[t]);
  shb_arena_free(&l->arena);
  free(l);
}

static bool any(const double complex *x, int n) {
  for (int i = 0; x && i < n; i++)
    if (x[i] != 0) return true;
  return false;
}

bool mhb_residual_terms_driven(const mhb_residual_terms *l, int k) {
  const int n = l->relative.n, q = 3 * l->model->n_probes, r = l->r;
  bool      driven = l->F && any(l->F + k * r, r);
  for (int t = 0; t < MODAL_TERMS; t++)
    driven = driven || (l->load[t] && any(l->load[t] + k * n, n)) ||
             (l->probe_load[t] && any(l->probe_load[t] + k * q, q));
  return driven;
}

/* ---- at a frequency ---- */

/* NULL without shapes of attachment: r = 0. */
static const double complex *shapes(const mhb_residual_terms *l, int k) {
  return !l->S ? NULL : l->S + (size_t)k * (size_t)l->relative.n * (size_t)l->r;
}

/* sum_t weight_t x_t at i, over the terms there are. */
MHB_INLINE double complex series(double complex *const x[MODAL_TERMS],
                                 const double weight[MODAL_TERMS], size_t i) {
  double re = 0, im = 0;
  for (int t = 0; t < MODAL_TERMS; t++)
    if (x[t] && weight[t] != 0) {
      re += weight[t] * creal(x[t][i]);
      im += weight[t] * cimag(x[t][i]);
    }
  return CMPLX(re, im);
}

/* Weight of residual mode i; 0 beyond those of the harmonic. */
MHB_INLINE double mode_weight(const mhb_residual_terms *l, int k, int i, const modal_series *s,
                              double *slope) {
  const modal_model *model = l->wave[k].model;
  *slope                   = 0;
  return i < model->n_residual ? modal_series_mode(model, i, s, slope) : 0;
}

void mhb_residual_terms_add_product(const mhb_residual_terms *l, int t, int k, double factor,
                                    const double complex *p, double complex *to) {
  const size_t n = (size_t)l->relative.n;
  if (l->contact[t]) mhb_cyclic_flexibility_add_product(l->contact[t], l->phase[k], factor, p, to);
  for (size_t i = 0; l->own[t] && i < n; i++) {
    const double complex *row = l->own[t] + ((size_t)k * n + i) * n;
    double complex        sum = 0;
    for (size_t j = 0; j < n; j++) sum += row[j] * p[j];
    to[i] += factor * sum;
  }
}

/* R[n][n] += factor times term t. */
static void add_term(const mhb_residual_terms *l, int t, int k, double factor, double complex *R) {
  const size_t square = (size_t)l->relative.n * (size_t)l->relative.n;
  if (l->contact[t]) mhb_cyclic_flexibility_add(l->contact[t], l->phase[k], factor, R);
  for (size_t i = 0; l->own[t] && i < square; i++)
    R[i] += factor * l->own[t][(size_t)k * square + i];
}

static void add_term_block(const mhb_residual_terms *l, int t, int k, double factor, int pair,
                           double complex R[3][3]) {
  const size_t n = (size_t)l->relative.n;
  if (l->contact[t]) mhb_cyclic_flexibility_add_block(l->contact[t], l->phase[k], factor, pair, R);
  for (size_t i = 0; l->own[t] && i < 9; i++)
    R[i / 3][i % 3] +=
        factor *
        l->own[t][((size_t)k * n + 3 * (size_t)pair + i / 3) * n + 3 * (size_t)pair + i % 3];
}

/* R += S g S^H by rows */
MHB_HOT static void add_small(const mhb_residual_terms *l, const double complex *S, const double *g,
                              double complex *R) {
  const int n = l->relative.n, r = l->r;
  for (int a = 0; a < n; a++)
    for (int b = 0; b < n; b++) {
      const double complex *x = S + a * r, *y = S + b * r;
      double                re = 0, im = 0;
      for (int i = 0; i < r; i++) {
        re += g[i] * (creal(x[i]) * creal(y[i]) + cimag(x[i]) * cimag(y[i]));
        im += g[i] * (cimag(x[i]) * creal(y[i]) - creal(x[i]) * cimag(y[i]));
      }
      R[a * n + b] += CMPLX(re, im);
    }
}

static void add_large(const mhb_residual_terms *l, const double complex *S, const double *g,
                      double complex *R) {
  const int      n = l->relative.n, r = l->r;
  double complex one = 1;
  for (int a = 0; a < n; a++)
    for (int i = 0; i < r; i++) l->Sg[a * r + i] = g[i] * S[a * r + i];
  cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasConjTrans, n, n, r, &one, l->Sg, r, S, r, &one, R,
              n);
}

void mhb_residual_terms_matrix(const mhb_residual_terms *l, int k, double w, double complex *R) {
  const int    r = l->r;
  modal_series s = modal_series_at(l->wave[k].model, w);
  double       g[r + 1], slope;
  for (int t = 0; t < MODAL_TERMS; t++) add_term(l, t, k, s.weight[t], R);
  for (int i = 0; i < r; i++) g[i] = mode_weight(l, k, i, &s, &slope);
  if (r > 0 && w > 0)
    (l->relative.n < MHB_WORTH_BLAS ? add_small : add_large)(l, shapes(l, k), g, R);
}

void mhb_residual_terms_block(const mhb_residual_terms *l, int k, double w, int pair,
                              double complex R[3][3]) {
  const int             r = l->r;
  modal_series          s = modal_series_at(l->wave[k].model, w);
  const double complex *S = shapes(l, k) + 3 * pair * r;
  double                slope;
  for (int t = 0; t < MODAL_TERMS; t++) add_term_block(l, t, k, s.weight[t], pair, R);
  for (int i = 0; i < r; i++) {
    double g = mode_weight(l, k, i, &s, &slope);
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) R[a][b] += g * S[a * r + i] * conj(S[b * r + i]);
  }
}

/* Force on residual mode i: load F - S^H p. */
static double complex drive(const mhb_residual_terms *l, int k, int i, double load,
                            const double complex *p) {
  const int             r = l->r;
  const double complex *S = shapes(l, k) + i;
  double complex        f = load * l->F[k * r + i];
  for (int a = 0; p && a < l->relative.n; a++) f -= conj(S[a * r]) * p[a];
  return f;
}

/* to[n] += factor (load x - matrix p), by the terms, with their weights or slopes. */
static void add_terms(const mhb_residual_terms *l, int k, const modal_series *s, bool slopes,
                      double factor, double load, const double complex *p, double complex *to) {
  const int     n       = l->relative.n;
  const double *contact = slopes ? s->slope : s->weight;
  const double *loaded  = slopes ? s->load_slope : s->load_weight;
  for (int a = 0; a < n; a++)
    to[a] += factor * load * series(l->load, loaded, (size_t)k * (size_t)n + (size_t)a);
  for (int t = 0; t < MODAL_TERMS && p; t++)
    if (contact[t] != 0) mhb_residual_terms_add_product(l, t, k, -factor * contact[t], p, to);
}

/* The same by the residual modes. */
static void add_modes(const mhb_residual_terms *l, int k, const modal_series *s, bool slopes,
                      double factor, double load, const double complex *p, double complex *to) {
  const int             n = l->relative.n, r = l->r;
  const double complex *S = shapes(l, k);
  for (int i = 0; i < r; i++) {
    double         slope, g = mode_weight(l, k, i, s, &slope);
    double complex f = factor * (slopes ? slope : g) * drive(l, k, i, load, p);
    for (int a = 0; a < n; a++) to[a] += S[a * r + i] * f;
  }
}

void mhb_residual_terms_motion_by(const mhb_residual_terms *l, int k, const modal_series *s,
                                  double scale, const double complex *p, double complex *motion) {
  add_terms(l, k, s, false, 1, scale, p, motion);
}

void mhb_residual_terms_load(const mhb_residual_terms *l, int k, double w, double scale,
                             double complex *motion) {
  const int             n = l->relative.n, r = l->r;
  const double complex *S = shapes(l, k);
  modal_series          s = modal_series_at(l->wave[k].model, w);
  for (int a = 0; a < n; a++)
    motion[a] += scale * series(l->load, s.load_weight, (size_t)k * (size_t)n + (size_t)a);
  for (int i = 0; i < r; i++) {
    double         slope;
    double complex f = scale * mode_weight(l, k, i, &s, &slope) * l->F[k * r + i];
    for (int a = 0; a < n; a++) motion[a] += S[a * r + i] * f;
  }
}

void mhb_residual_terms_motion(const mhb_residual_terms *l, int k, double w, double scale,
                               const double complex *p, double complex *motion) {
  modal_series s = modal_series_at(l->wave[k].model, w);
  add_terms(l, k, &s, false, 1, scale, p, motion);
  add_modes(l, k, &s, false, 1, scale, p, motion);
}

void mhb_residual_terms_slope(const mhb_residual_terms *l, int k, double w, double dw2,
                              double scale, const double complex *p, double complex *slope) {
  modal_series s = modal_series_at(l->wave[k].model, w);
  add_terms(l, k, &s, true, dw2, scale, p, slope);
  add_modes(l, k, &s, true, dw2, scale, p, slope);
}

/* Motion of probe dof c in residual mode i; 0 beyond those of the harmonic. */
MHB_INLINE double complex probe_shape(const modal_wave *wave, int c, int i) {
  const double *im = wave->imaginary ? wave->imaginary->residual_probe : NULL;
  const int     r  = wave->model->n_residual;
  return i < r ? modal_wave_value(wave, wave->model->residual_probe, im,
                                  (size_t)c * (size_t)r + (size_t)i)
               : 0;
}

/* change[3 q] += P_i (g F(change) + dw2 g' F), F the force on residual mode i of shape P_i. */
static void add_probe_modes(const mhb_residual_terms *l, int k, const modal_series *s,
                            mhb_structure_forces at, mhb_structure_forces by, double dw2,
                            double complex *change) {
  const int q = 3 * l->model->n_probes, r = l->r;
  for (int i = 0; i < r; i++) {
    double         slope, g = mode_weight(l, k, i, s, &slope);
    double complex f = g * drive(l, k, i, by.scale, by.p);
    if (dw2 != 0) f += dw2 * slope * drive(l, k, i, at.scale, at.p);
    for (int c = 0; c < q; c++) change[c] += probe_shape(&l->wave[k], c, i) * f;
  }
}

/* change[3 q] += scale load - matrix p, by the terms. */
static void add_probe_terms(const mhb_residual_terms *l, int k, const double weight[MODAL_TERMS],
                            double scale, const double complex *p, double complex *change) {
  const size_t n = (size_t)l->relative.n, q = 3 * (size_t)l->model->n_probes;
  for (size_t c = 0; c < q; c++) {
    const size_t at = (size_t)k * q + c;
    change[c] += scale * series(l->probe_load, weight, at);
    for (size_t b = 0; b < n; b++) change[c] -= series(l->probe_contact, weight, at * n + b) * p[b];
  }
}

void mhb_residual_terms_probe_by(const mhb_residual_terms *l, int k, const modal_series *s,
                                 double scale, const double complex *p, double complex *motion) {
  add_probe_terms(l, k, s->load_weight, scale, p, motion);
}

void mhb_residual_terms_probe_change(const mhb_residual_terms *l, int k, double w,
                                     mhb_structure_forces at, mhb_structure_forces by, double dw2,
                                     double complex *change) {
  modal_series s = modal_series_at(l->wave[k].model, w);
  add_probe_terms(l, k, s.load_weight, by.scale, by.p, change);
  for (int t = 0; t < MODAL_TERMS; t++) s.load_slope[t] *= dw2;
  if (dw2 != 0) add_probe_terms(l, k, s.load_slope, at.scale, at.p, change);
  add_probe_modes(l, k, &s, at, by, dw2, change);
}
