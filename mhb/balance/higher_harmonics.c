#include "mhb/balance/higher_harmonics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/fourier.h"
#include "mhb/numerics/lu.h"

static int most(int a, int b) {
  return a > b ? a : b;
}

static int allocate(mhb_higher_harmonics *b) {
  size_t K = (size_t)(b->last - b->first + 1), n = (size_t)b->n, m = (size_t)b->n_modes;
  size_t row = 3 * (size_t)mhb_real_size(b->last);
  b->x       = calloc(row, sizeof(double));
  b->p       = calloc(row, sizeof(double));
  b->force   = calloc(K * n, sizeof(double complex));
  b->u       = calloc(K * n, sizeof(double complex));
  b->D       = calloc(3 * n, sizeof(double complex));
  b->W       = calloc(3 * n, sizeof(double complex));
  b->c       = calloc(n, sizeof(double complex));
  b->A       = calloc(b->by_modes ? m * m : n * n, sizeof(double complex));
  b->y       = calloc(m, sizeof(double complex));
  b->V       = calloc(3 * m, sizeof(double complex));
  b->pivot   = calloc((size_t)most(b->n, b->n_modes), sizeof(int));
  return b->x && b->p && b->force && b->u && b->D && b->W && b->c && b->A && b->y && b->V &&
         b->pivot;
}

shb_status mhb_higher_harmonics_create(const mhb_balance *balance, mhb_receptance *receptance,
                                       mhb_higher_harmonics **out) {
  mhb_higher_harmonics *b = calloc(1, sizeof *b);
  SHB_CHECK(b, SHB_ERR_IO, "out of memory");
  b->first          = balance->m + 1;
  b->last           = receptance->n_harmonics;
  b->n              = receptance->n;
  b->n_modes        = receptance->n_modes;
  b->by_modes       = b->n > b->n_modes;
  b->receptance     = receptance;
  shb_status status = SHB_OK;
  if (!allocate(b))
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory for %d harmonics", b->last);
  if (status == SHB_OK)
    status =
        mhb_contact_evaluator_create(b->last, b->last, balance->settings->tolerance, &b->contact);
  if (status != SHB_OK) {
    mhb_higher_harmonics_destroy(b);
    return status;
  }
  *out = b;
  return SHB_OK;
}

void mhb_higher_harmonics_destroy(mhb_higher_harmonics *b) {
  if (!b) return;
  mhb_contact_evaluator_destroy(b->contact);
  free(b->x);
  free(b->p);
  free(b->force);
  free(b->u);
  free(b->D);
  free(b->W);
  free(b->A);
  free(b->c);
  free(b->y);
  free(b->V);
  free(b->pivot);
  free(b);
}

/* Harmonic k of an array [k - first][n]. */
static double complex *at(const mhb_higher_harmonics *b, double complex *array, int k) {
  return array + (size_t)(k - b->first) * (size_t)b->n;
}

/* Stiffness of a pair at the last harmonic that turns with the motion: what couples k with -k is left out. */
static void stiffness(const mhb_balance *b, int pair, double complex D[3][3]) {
  size_t        block = 3 * (size_t)b->nb;
  const double *dp    = b->eval->dp + (size_t)pair * block * block;
  for (int c = 0; c < 3; c++) {
    const double *re = dp + ((size_t)((c + 1) * b->nb) - 2) * block, *im = re + block;
    for (int d = 0; d < 3; d++) {
      int j   = (d + 1) * b->nb - 2;
      D[c][d] = .5 * CMPLX(re[j] + im[j + 1], im[j] - re[j + 1]);
    }
  }
}

/* b->p <- forces of a pair under x, with the harmonics beyond or without them. */
static void pair_force(mhb_higher_harmonics *b, const mhb_balance *balance, const double *x,
                       int pair, int with) {
  int              wide = mhb_real_size(b->last), nb = balance->nb;
  mhb_contact_info info;
  memset(b->x, 0, sizeof(double) * 3 * (size_t)wide);
  for (int c = 0; c < 3; c++) {
    double *to = b->x + c * wide;
    memcpy(to, x + (size_t)(3 * pair + c) * (size_t)nb, sizeof(double) * (size_t)nb);
    for (int k = b->first; with && k <= b->last; k++) {
      to[2 * k - 1] = creal(at(b, b->u, k)[3 * pair + c]);
      to[2 * k]     = cimag(at(b, b->u, k)[3 * pair + c]);
    }
  }
  mhb_contact_force(b->contact, &balance->law[pair], b->x, b->p, NULL, &info);
}

static void set_forces(mhb_higher_harmonics *b, const mhb_balance *balance, const double *x) {
  int wide = mhb_real_size(b->last);
  memset(b->force, 0, sizeof *b->force * (size_t)(b->last - b->first + 1) * (size_t)b->n);
  for (int a = 0; a < balance->n_pairs; a++) {
    stiffness(balance, a, (double complex(*)[3])(b->D + 9 * a));
    if (balance->eval->kind[a] != MHB_PAIR_NONLINEAR) continue;
    pair_force(b, balance, x, a, 0);
    for (int k = b->first; k <= b->last; k++)
      for (int c = 0; c < 3; c++)
        at(b, b->force, k)[3 * a + c] = CMPLX(b->p[c * wide + 2 * k - 1], b->p[c * wide + 2 * k]);
  }
}

static double power_of(int n, const double complex *u) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += creal(u[i]) * creal(u[i]) + cimag(u[i]) * cimag(u[i]);
  return sum;
}

/* ---- as it stands ---- */

/* A <- I + R_k D, column-major. */
static void fill(mhb_higher_harmonics *b, int k) {
  int n = b->n;
  mhb_receptance_update(b->receptance, k);
  const double complex *R = b->receptance->R + (size_t)k * (size_t)n * (size_t)n;
  for (int i = 0; i < n; i++, R += n)
    for (int j = 0; j < n; j++) {
      const double complex *D = b->D + 9 * (j / 3) + j % 3, *r = R + j - j % 3;
      b->A[(size_t)j * (size_t)n + (size_t)i] = r[0] * D[0] + r[1] * D[3] + r[2] * D[6] + (i == j);
    }
}

/* u <- (I + R_k D)^-1 c; 0: singular. */
static int solve_pairs(mhb_higher_harmonics *b, int k, double complex *u) {
  fill(b, k);
  memcpy(u, b->c, sizeof *u * (size_t)b->n);
  return mhb_factor_complex(b->n, b->A, b->pivot) && mhb_solve_complex(b->n, b->A, b->pivot, 1, u);
}

/* ---- in the modes ---- */

/* W of a pair. */
static void set_own(mhb_higher_harmonics *b, int k, int pair, double complex W[3][3]) {
  const mhb_receptance *r       = b->receptance;
  const double complex *D       = b->D + 9 * pair;
  double complex        G[3][3] = {{0}}, A[9];
  int                   pivot[3];
  mhb_residual_terms_block(r->residual_terms, k, k * r->omega / r->nu, pair, G);
  for (int c = 0; c < 3; c++)
    for (int d = 0; d < 3; d++)
      A[3 * d + c] = G[c][0] * D[d] + G[c][1] * D[3 + d] + G[c][2] * D[6 + d] + (c == d);
  int ok = mhb_factor_complex(3, A, pivot);
  for (int d = 0; d < 3; d++) {
    double complex column[3] = {d == 0, d == 1, d == 2};
    if (ok) mhb_solve_complex(3, A, pivot, 1, column);
    for (int c = 0; c < 3; c++) W[c][d] = column[c];
  }
}

/* 1/(w_i^2 - w^2 + 2 j zeta_i w_i w) */
static double complex mode(const mhb_receptance *r, int k, int i) {
  double w = k * r->omega / r->nu, wi = SHB_TWO_PI * r->model->frequency[i];
  return 1 / CMPLX(wi * wi - w * w, 2 * r->model->damping_ratio[i] * wi * w);
}

/* A, y += those of a pair, before L. */
static void add_pair(mhb_higher_harmonics *b, const double complex *B, int pair) {
  int                   m = b->n_modes;
  const double complex *D = b->D + 9 * pair, *W = b->W + 9 * pair, *c = b->c + 3 * pair;
  for (int i = 0; i < 3; i++) {
    double complex DW[3], *V = b->V + i * m;
    for (int j = 0; j < 3; j++)
      DW[j] = D[3 * i] * W[j] + D[3 * i + 1] * W[3 + j] + D[3 * i + 2] * W[6 + j];
    for (int j = 0; j < m; j++) V[j] = DW[0] * B[j] + DW[1] * B[m + j] + DW[2] * B[2 * m + j];
    double complex f = DW[0] * c[0] + DW[1] * c[1] + DW[2] * c[2];
    for (int j = 0; j < m; j++) b->y[j] += conj(B[i * m + j]) * f;
  }
  for (int j = 0; j < m; j++)
    for (int l = 0; l < m; l++)
      b->A[j * m + l] += conj(B[l]) * b->V[j] + conj(B[m + l]) * b->V[m + j] +
                         conj(B[2 * m + l]) * b->V[2 * m + j];
}

static int solve_modes(mhb_higher_harmonics *b, int k, double complex *u) {
  int                   m = b->n_modes;
  const double complex *B = b->receptance->B + (size_t)k * (size_t)b->n * (size_t)m;
  memset(b->A, 0, sizeof *b->A * (size_t)m * (size_t)m);
  memset(b->y, 0, sizeof *b->y * (size_t)m);
  for (int a = 0; a < b->n / 3; a++) {
    set_own(b, k, a, (double complex(*)[3])(b->W + 9 * a));
    if (power_of(9, b->D + 9 * a) > 0) add_pair(b, B + 3 * a * m, a);
  }
  for (int i = 0; i < m; i++) {
    double complex L = mode(b->receptance, k, i);
    b->y[i] *= L;
    for (int j = 0; j < m; j++) b->A[j * m + i] = L * b->A[j * m + i] + (i == j);
  }
  if (!mhb_factor_complex(m, b->A, b->pivot) || !mhb_solve_complex(m, b->A, b->pivot, 1, b->y))
    return 0;
  for (int row = 0; row < b->n; row++)
    for (int i = 0; i < m; i++) b->c[row] -= B[row * m + i] * b->y[i];
  for (int row = 0; row < b->n; row++) {
    const double complex *W = b->W + 3 * row, *c = b->c + row - row % 3;
    u[row] = W[0] * c[0] + W[1] * c[1] + W[2] * c[2];
  }
  return 1;
}

/* ---- */

double mhb_higher_harmonics_estimate(mhb_higher_harmonics *b, const mhb_balance *balance,
                                     const double *x) {
  double sum = 0;
  set_forces(b, balance, x);
  for (int k = b->first; k <= b->last; k++) {
    double complex *u = at(b, b->u, k);
    mhb_receptance_motion(b->receptance, k, at(b, b->force, k), b->c);
    if (!(b->by_modes ? solve_modes(b, k, u) : solve_pairs(b, k, u)))
      memset(u, 0, sizeof *u * (size_t)b->n);
    sum += power_of(b->n, u);
  }
  return sqrt(sum);
}

void mhb_higher_harmonics_feedback(mhb_higher_harmonics *b, const mhb_balance *balance,
                                   const double *x, double *change) {
  int    wide = mhb_real_size(b->last), nb = balance->nb, n = b->n;
  size_t size = sizeof(double) * (size_t)balance->n;
  memset(change, 0, size);
  for (int a = 0; a < balance->n_pairs; a++) { /* first the forces */
    if (balance->eval->kind[a] != MHB_PAIR_NONLINEAR) continue;
    pair_force(b, balance, x, a, 1);
    for (int row = 3 * a, c = 0; c < 3; c++, row++)
      for (int i = 0; i < nb; i++)
        change[row * nb + i] = b->p[c * wide + i] - balance->eval->p[row * nb + i];
  }
  for (int k = 0; k <= balance->m; k++) {
    mhb_receptance_update(b->receptance, k);
    const double complex *R = b->receptance->R + (size_t)k * (size_t)n * (size_t)n;
    for (int row = 0; row < n; row++)
      b->c[row] =
          k ? CMPLX(change[row * nb + 2 * k - 1], change[row * nb + 2 * k]) : change[row * nb];
    for (int row = 0; row < n; row++, R += n) {
      double re = 0, im = 0;
      for (int j = 0; j < n; j++) {
        re += creal(R[j]) * creal(b->c[j]) - cimag(R[j]) * cimag(b->c[j]);
        im += creal(R[j]) * cimag(b->c[j]) + cimag(R[j]) * creal(b->c[j]);
      }
      change[row * nb + (k ? 2 * k - 1 : 0)] = re;
      if (k) change[row * nb + 2 * k] = im;
    }
  }
}

double mhb_higher_harmonics_power(const mhb_higher_harmonics *b, int k) {
  return k < b->first || k > b->last ? 0 : power_of(b->n, at(b, b->u, k));
}
