#include "mhb/balance/higher_harmonics.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/numerics/fourier.h"
#include "mhb/numerics/lu.h"

static int most(int a, int b) {
  return a > b ? a : b;
}

static void allocate(mhb_higher_harmonics *h, int product, size_t change) {
  size_t K = (size_t)h->last - (size_t)h->first + 1, n = (size_t)h->n, m = (size_t)h->n_modes;
  size_t row = 3 * (size_t)mhb_real_size(h->last);
  h->x       = shb_arena_take(&h->arena, row, sizeof(double));
  h->p       = shb_arena_take(&h->arena, row, sizeof(double));
  h->force   = shb_arena_take(&h->arena, K * n, sizeof(double complex));
  h->u       = shb_arena_take(&h->arena, K * n, sizeof(double complex));
  h->D       = shb_arena_take(&h->arena, 3 * n, sizeof(double complex));
  h->W       = shb_arena_take(&h->arena, 3 * n, sizeof(double complex));
  h->c       = shb_arena_take(&h->arena, n, sizeof(double complex));
  if (h->by_modes && h->receptance->part && h->receptance->part->G)
    h->stiffness = shb_arena_take(&h->arena, m * m, sizeof(double complex));
  h->A        = shb_arena_take(&h->arena, h->by_modes ? m * m : n * n, sizeof(double complex));
  h->y        = shb_arena_take(&h->arena, m, sizeof(double complex));
  h->V        = shb_arena_take(&h->arena, n * m, sizeof(double complex));
  h->C        = shb_arena_take(&h->arena, m * m, sizeof(double complex));
  h->f        = shb_arena_take(&h->arena, n, sizeof(double complex));
  size_t high = product ? 2 * K * n : 0;
  h->change   = shb_arena_take(&h->arena, change > high ? change : high, sizeof(double));
  h->motion   = shb_arena_take(&h->arena, high, sizeof(double));
  h->pivot    = shb_arena_take(&h->arena, (size_t)most(h->n, h->n_modes), sizeof(int));
}

shb_status mhb_higher_harmonics_create(const mhb_balance *balance, mhb_receptance *receptance,
                                       mhb_higher_harmonics **out) {
  mhb_higher_harmonics *h = shb_alloc_zeroed(1, sizeof *h);
  h->first                = balance->m + 1;
  h->last                 = receptance->n_harmonics;
  h->n                    = receptance->n;
  h->n_modes              = receptance->n_modes;
  h->by_modes             = h->n > h->n_modes;
  h->receptance           = receptance;
  allocate(h, balance->product != NULL, balance->product ? (size_t)balance->n : 0);
  const shb_status status =
      mhb_contact_evaluator_create(h->last, h->last, balance->settings->tolerance, &h->contact);
  if (status != SHB_OK) {
    mhb_higher_harmonics_destroy(h);
    return status;
  }
  if (balance->product) h->product = mhb_balance_product(balance, receptance, h->first, h->last);
  *out = h;
  return SHB_OK;
}

void mhb_higher_harmonics_destroy(mhb_higher_harmonics *h) {
  if (!h) return;
  mhb_contact_evaluator_destroy(h->contact);
  mhb_receptance_product_destroy(h->product);
  shb_arena_free(&h->arena);
  free(h);
}

/* Harmonic k of an array [k - first][n]. */
static double complex *harmonic_of(const mhb_higher_harmonics *h, double complex *array, int k) {
  return array + (size_t)(k - h->first) * (size_t)h->n;
}

void mhb_last_stiffness(const mhb_balance *b, int pair, double complex D[3][3]) {
  size_t        block = 3 * (size_t)b->nb;
  const double *dp    = b->eval->dp + (size_t)pair * block * block;
  for (int c = 0; c < 3; c++) {
    const double *re = dp + ((size_t)((c + 1) * b->nb) - 2) * block, *im = re + block;
    for (int d = 0; d < 3; d++) {
      int j   = (d + 1) * b->nb - 2;
      D[c][d] = 0.5 * CMPLX(re[j] + im[j + 1], im[j] - re[j + 1]);
    }
  }
}

/* h->p <- forces of a pair at x, with the higher harmonics h->u or without them. */
static void pair_force(mhb_higher_harmonics *h, const mhb_balance *balance, const double *x,
                       int pair, int with_higher) {
  int              wide = mhb_real_size(h->last), nb = balance->nb;
  mhb_contact_info info;
  memset(h->x, 0, sizeof(double) * 3 * (size_t)wide);
  for (int c = 0; c < 3; c++) {
    double *to = h->x + c * wide;
    memcpy(to, x + (size_t)(3 * pair + c) * (size_t)nb, sizeof(double) * (size_t)nb);
    for (int k = h->first; with_higher && k <= h->last; k++) {
      to[2 * k - 1] = creal(harmonic_of(h, h->u, k)[3 * pair + c]);
      to[2 * k]     = cimag(harmonic_of(h, h->u, k)[3 * pair + c]);
    }
  }
  mhb_contact_force_near(h->contact, &balance->law[pair], mhb_balance_slider(balance, pair), h->x,
                         h->p, NULL, &info);
}

void mhb_higher_harmonics_set_force(mhb_higher_harmonics *h, int pair, const double *p) {
  const int wide = mhb_real_size(h->last);
  for (int k = h->first; k <= h->last; k++)
    for (int c = 0; c < 3; c++)
      harmonic_of(h, h->force, k)[3 * pair + c] =
          p ? CMPLX(p[c * wide + 2 * k - 1], p[c * wide + 2 * k]) : 0;
}

void mhb_higher_harmonics_evaluate(mhb_higher_harmonics *h, const mhb_balance *balance,
                                   const double *x) {
  for (int a = 0; a < balance->n_pairs; a++) {
    const bool moves = balance->eval->kind[a] == MHB_PAIR_NONLINEAR;
    if (moves) pair_force(h, balance, x, a, 0);
    mhb_higher_harmonics_set_force(h, a, moves ? h->p : NULL);
  }
}

static double power_of(int n, const double complex *u) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += creal(u[i]) * creal(u[i]) + cimag(u[i]) * cimag(u[i]);
  return sum;
}

/* ---- unknowns u ---- */

void mhb_harmonic_matrix(int n, const double complex *R, const double complex (*D)[9],
                         double complex *A) {
  for (int i = 0; i < n; i++, R += n)
    for (int j = 0; j < n; j++) {
      const double complex *d = D[j / 3] + j % 3, *row = R + j - j % 3;
      A[(size_t)j * (size_t)n + (size_t)i] =
          row[0] * d[0] + row[1] * d[3] + row[2] * d[6] + (i == j);
    }
}

/* u <- (I + R_k D)^-1 c; 0: singular. */
static int solve_pairs(mhb_higher_harmonics *h, int k, double complex *u) {
  const size_t n = (size_t)h->n;
  mhb_receptance_update(h->receptance, k);
  mhb_harmonic_matrix(h->n, h->receptance->R + (size_t)k * n * n, (const double complex(*)[9])h->D,
                      h->A);
  memcpy(u, h->c, sizeof *u * n);
  return mhb_factor_complex(h->n, h->A, h->pivot) && mhb_solve_complex(h->n, h->A, h->pivot, 1, u);
}

/* ---- unknowns y of the modes ---- */

/* W = (I + G D)^-1 of a pair; I where singular. */
static void set_W(mhb_higher_harmonics *h, int k, int pair, double complex W[3][3]) {
  const mhb_receptance *r       = h->receptance;
  double complex        G[3][3] = {{0}}, A[9];
  int                   pivot[3];
  mhb_residual_terms_block(r->residual_terms, k, k * r->omega / r->nu, pair, G);
  mhb_harmonic_matrix(3, G[0], (const double complex(*)[9])(h->D + 9 * pair), A);
  int ok = mhb_factor_complex(3, A, pivot);
  for (int d = 0; d < 3; d++) {
    double complex column[3] = {d == 0, d == 1, d == 2};
    if (ok) mhb_solve_complex(3, A, pivot, 1, column);
    for (int c = 0; c < 3; c++) W[c][d] = column[c];
  }
}

/* 1/(w_i^2 - w^2 + 2 j zeta_i w_i w) */
static double complex modal_receptance(const mhb_receptance *r, int k, int i) {
  const modal_model *model = mhb_receptance_model(r, k);
  double             w = k * r->omega / r->nu, wi = SHB_TWO_PI * model->frequency[i];
  return 1.0 / CMPLX(wi * wi - w * w, 2 * model->damping_ratio[i] * wi * w);
}

/* Rows of a pair: V <- D W B [3][modes], f <- D W c [3]. */
static void set_rows(mhb_higher_harmonics *h, const double complex *B, int pair) {
  const int             m = h->n_modes;
  const double complex *D = h->D + 9 * pair, *W = h->W + 9 * pair, *c = h->c + 3 * pair;
  for (int i = 0; i < 3; i++) {
    double complex DW[3], *V = h->V + (3 * pair + i) * m;
    for (int j = 0; j < 3; j++)
      DW[j] = D[3 * i] * W[j] + D[3 * i + 1] * W[3 + j] + D[3 * i + 2] * W[6 + j];
    for (int j = 0; j < m; j++) V[j] = DW[0] * B[j] + DW[1] * B[m + j] + DW[2] * B[2 * m + j];
    h->f[3 * pair + i] = DW[0] * c[0] + DW[1] * c[1] + DW[2] * c[2];
  }
}

static int solve_modes(mhb_higher_harmonics *h, int k, double complex *u) {
  const int             m = h->n_modes, n = h->n;
  const double complex *B   = h->receptance->B + (size_t)k * (size_t)n * (size_t)m;
  const double complex  one = 1, less = -1, none = 0;
  for (int a = 0; a < n / 3; a++) {
    set_W(h, k, a, (double complex(*)[3])(h->W + 9 * a));
    set_rows(h, B + 3 * a * m, a);
  }
  cblas_zgemv(CblasRowMajor, CblasConjTrans, n, m, &one, B, m, h->f, 1, &none, h->y, 1);
  cblas_zgemm(CblasRowMajor, CblasConjTrans, CblasNoTrans, m, m, n, &one, B, m, h->V, m, &none,
              h->C, m);
  if (h->stiffness) { /* Coriolis terms: L is no diagonal, its inverse is known */
    const mhb_receptance *r = h->receptance;
    mhb_receptance_dynamic_stiffness(r, k, k * r->omega / r->nu, h->stiffness);
    for (int i = 0; i < m; i++)
      for (int j = 0; j < m; j++) h->A[j * m + i] = h->C[i * m + j] + h->stiffness[j * m + i];
  }
  for (int i = 0; i < m && !h->stiffness; i++) {
    double complex L = modal_receptance(h->receptance, k, i);
    h->y[i] *= L;
    for (int j = 0; j < m; j++) h->A[j * m + i] = L * h->C[i * m + j] + (i == j);
  }
  if (!mhb_factor_complex(m, h->A, h->pivot) || !mhb_solve_complex(m, h->A, h->pivot, 1, h->y))
    return 0;
  cblas_zgemv(CblasRowMajor, CblasNoTrans, n, m, &less, B, m, h->y, 1, &one, h->c, 1);
  for (int row = 0; row < n; row++) {
    const double complex *W = h->W + 3 * row, *c = h->c + row - row % 3;
    u[row] = W[0] * c[0] + W[1] * c[1] + W[2] * c[2];
  }
  return 1;
}

/* ---- all harmonics ---- */

/* h->motion <- R p_k of all harmonics of many pairs. */
static void set_motions(mhb_higher_harmonics *h, double negligible) {
  int nb = h->product->nb;
  for (int k = h->first; k <= h->last; k++) {
    const double complex *p  = harmonic_of(h, h->force, k);
    double               *to = h->change + mhb_product_column(h->product, k);
    for (int i = 0; i < h->n; i++, to += nb) {
      to[0] = creal(p[i]);
      to[1] = cimag(p[i]);
    }
  }
  mhb_receptance_product_update(h->product);
  mhb_receptance_product_apply(h->product, MHB_PRODUCT_VALUE, negligible, h->change, h->motion);
}

/* h->c <- free_k - R_k p_k */
static void set_free_motion(mhb_higher_harmonics *h, int k) {
  if (!h->product) {
    mhb_receptance_motion(h->receptance, k, harmonic_of(h, h->force, k), h->c);
    return;
  }
  const double *from = h->motion + mhb_product_column(h->product, k);
  for (int i = 0; i < h->n; i++, from += h->product->nb)
    h->c[i] = h->receptance->free[k * h->n + i] - CMPLX(from[0], from[1]);
}

double mhb_higher_harmonics_estimate(mhb_higher_harmonics *h, const mhb_balance *stiffness,
                                     double negligible) {
  double sum = 0;
  for (int a = 0; a < stiffness->n_pairs; a++)
    mhb_last_stiffness(stiffness, a, (double complex(*)[3])(h->D + 9 * a));
  if (h->product) set_motions(h, negligible);
  for (int k = h->first; k <= h->last; k++) {
    double complex *u = harmonic_of(h, h->u, k);
    set_free_motion(h, k);
    if (!(h->by_modes ? solve_modes(h, k, u) : solve_pairs(h, k, u)))
      memset(u, 0, sizeof *u * (size_t)h->n);
    sum += power_of(h->n, u);
  }
  return sqrt(sum);
}

void mhb_higher_harmonics_feedback(mhb_higher_harmonics *h, const mhb_balance *balance,
                                   const mhb_balance *stiffness, const double *x, double *change) {
  int    wide = mhb_real_size(h->last), nb = balance->nb, n = h->n;
  size_t size = sizeof(double) * (size_t)balance->n;
  memset(change, 0, size);
  for (int a = 0; a < balance->n_pairs; a++) { /* change of the forces */
    if (stiffness->eval->kind[a] != MHB_PAIR_NONLINEAR) continue;
    pair_force(h, balance, x, a, 1);
    for (int row = 3 * a, c = 0; c < 3; c++, row++)
      for (int i = 0; i < nb; i++)
        change[row * nb + i] = h->p[c * wide + i] - balance->eval->p[row * nb + i];
  }
  if (balance->product) {
    memcpy(h->change, change, size);
    mhb_receptance_product_update(balance->product);
    mhb_receptance_product_apply(balance->product, MHB_PRODUCT_VALUE, balance->negligible,
                                 h->change, change);
    return;
  }
  for (int k = 0; k <= balance->m; k++) {
    mhb_receptance_update(h->receptance, k);
    const double complex *R = h->receptance->R + (size_t)k * (size_t)n * (size_t)n;
    for (int row = 0; row < n; row++)
      h->c[row] =
          k ? CMPLX(change[row * nb + 2 * k - 1], change[row * nb + 2 * k]) : change[row * nb];
    for (int row = 0; row < n; row++, R += n) {
      double re = 0, im = 0;
      for (int j = 0; j < n; j++) {
        re += creal(R[j]) * creal(h->c[j]) - cimag(R[j]) * cimag(h->c[j]);
        im += creal(R[j]) * cimag(h->c[j]) + cimag(R[j]) * creal(h->c[j]);
      }
      change[row * nb + (k ? 2 * k - 1 : 0)] = re;
      if (k) change[row * nb + 2 * k] = im;
    }
  }
}

double mhb_higher_harmonics_power(const mhb_higher_harmonics *h, int k) {
  return k < h->first || k > h->last ? 0 : power_of(h->n, harmonic_of(h, h->u, k));
}
