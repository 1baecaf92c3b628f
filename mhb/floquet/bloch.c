#include "mhb/floquet/bloch.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

/* An imaginary part below this share of the modulus is the rounding of a power. */
static const double REAL = 1e-11;

/* Inverse iteration: relative distance of the shift from lambda, so that the matrix is regular, and
 * change of lambda at which it ends. */
static const double BESIDE = 1e-9, SETTLED = 1e-7;
enum { INVERSE_STEPS = 12 };

static const double ROOT_TWO = 1.4142135623730952; /* rounded up */

void mhb_bloch_create(int cells, int capacity, mhb_bloch *b) {
  size_t n = (size_t)capacity, square = n * n;
  *b         = (mhb_bloch){.cells = cells, .capacity = capacity, .size = 34 * capacity};
  b->real    = shb_arena_take(&b->arena, square + 1, sizeof *b->real);
  b->re      = shb_arena_take(&b->arena, n + 1, sizeof *b->re);
  b->im      = shb_arena_take(&b->arena, n + 1, sizeof *b->im);
  b->work    = shb_arena_take(&b->arena, (size_t)b->size + 2 * n + 1, sizeof *b->work);
  b->matrix  = shb_arena_take(&b->arena, square + 1, sizeof *b->matrix);
  b->value   = shb_arena_take(&b->arena, 2 * n + 1, sizeof *b->value);
  b->aligned = shb_arena_take(&b->arena, n + 1, sizeof *b->aligned);
  b->pivot   = shb_arena_take(&b->arena, n + 1, sizeof *b->pivot);
  if (cells > 2) mhb_hessenberg_qr_create(capacity, &b->qr);
}

void mhb_bloch_destroy(mhb_bloch *b) {
  mhb_hessenberg_qr_destroy(&b->qr);
  shb_arena_free(&b->arena);
  *b = (mhb_bloch){0};
}

static double complex power(double complex z, int n) {
  double complex out = 1;
  for (; n; n /= 2, z *= z)
    if (n % 2) out *= z;
  return fabs(cimag(out)) <= REAL * cabs(out) ? creal(out) : out;
}

/* kappa = 0 or pi: S(kappa) is real. */
static int real_problem(mhb_bloch *b, int n, const double *S, int alternating,
                        double complex *value) {
  int square = n * n;
  memcpy(b->real, S, sizeof *S * (size_t)square);
  for (int c = 1; c < b->cells; c++)
    for (int i = 0; i < square; i++)
      b->real[i] += alternating && c % 2 ? -S[c * square + i] : S[c * square + i];
  if (LAPACKE_dgeev_work(LAPACK_COL_MAJOR, 'N', 'N', n, b->real, n, b->re, b->im, NULL, 1, NULL, 1,
                         b->work, b->size) != 0)
    return 0;
  for (int i = 0; i < n; i++) value[i] = CMPLX(b->re[i], b->im[i]);
  return 1;
}

/* matrix <- S(kappa) */
static void set_matrix(mhb_bloch *b, int n, const double *S, double kappa) {
  int square = n * n;
  for (int i = 0; i < square; i++) b->matrix[i] = S[i];
  for (int c = 1; c < b->cells; c++) {
    double complex turn = cexp(-I * kappa * c);
    for (int i = 0; i < square; i++) b->matrix[i] += turn * S[c * square + i];
  }
}

/* Note lambda[n] of wave l if the largest is among them. */
static void note_largest(mhb_bloch *b, int n, int l, const double complex *lambda) {
  double most = cabs(b->largest);
  for (int i = 0; i < n; i++) {
    if (fmax(fabs(creal(lambda[i])), fabs(cimag(lambda[i]))) * ROOT_TWO < most ||
        cabs(lambda[i]) <= most)
      continue;
    most       = cabs(lambda[i]);
    b->largest = lambda[i];
    b->wave    = l;
  }
}

static void note_aligned(mhb_bloch *b, int n, const double complex *lambda, int n_segments) {
  for (int i = 0; i < n; i++)
    if (cimag(lambda[i]) == 0 && creal(lambda[i]) > 0)
      b->aligned[b->n_aligned++] = pow(creal(lambda[i]), n_segments);
}

int mhb_bloch_waves(const mhb_bloch *b) {
  return b->cells / 2 + 1;
}

bool mhb_bloch_is_real(const mhb_bloch *b, int l) {
  return l == 0 || 2 * l == b->cells;
}

int mhb_bloch_eigenvalues(mhb_bloch *b, int n, const double *S, int l, double complex *lambda) {
  if (mhb_bloch_is_real(b, l)) return real_problem(b, n, S, l > 0, lambda);
  set_matrix(b, n, S, SHB_TWO_PI * l / b->cells);
  return mhb_hessenberg_qr_eigenvalues(&b->qr, n, b->matrix, lambda);
}

double complex mhb_bloch_multiplier(const mhb_bloch *b, int l, int n_segments, int cell_shift,
                                    double complex lambda) {
  double complex turn = mhb_bloch_is_real(b, l)
                            ? (l > 0 && cell_shift % 2 ? -1 : 1)
                            : cexp(-I * (SHB_TWO_PI * l / b->cells) * cell_shift);
  return turn * power(lambda, n_segments);
}

int mhb_bloch_multipliers(mhb_bloch *b, int n, const double *S, int n_segments, int cell_shift,
                          double complex *multiplier) {
  int done     = 0;
  b->wave      = 0;
  b->largest   = 0;
  b->n_aligned = 0;
  for (int l = 0; l < mhb_bloch_waves(b) && n > 0; l++) {
    double complex *lambda = b->value;
    if (!mhb_bloch_eigenvalues(b, n, S, l, lambda)) return 0;
    note_largest(b, n, l, lambda);
    if (l == 0) note_aligned(b, n, lambda, n_segments);
    for (int i = 0; i < n; i++) {
      multiplier[done++] = mhb_bloch_multiplier(b, l, n_segments, cell_shift, lambda[i]);
      if (mhb_bloch_is_real(b, l)) continue;
      multiplier[done] = conj(multiplier[done - 1]);
      done++;
    }
  }
  return 1;
}

/* Euclidean norm of x[n], which is scaled to 1. */
static double normalise(int n, double complex *x) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += creal(x[i]) * creal(x[i]) + cimag(x[i]) * cimag(x[i]);
  double size = sqrt(sum);
  for (int i = 0; i < n && size > 0; i++) x[i] /= size;
  return size;
}

double mhb_bloch_continued(mhb_bloch *b, int n, const double *S, int n_segments) {
  double complex  shift = b->largest * (1 + BESIDE), lambda = shift;
  double complex *x = b->value, *y = b->value + n;
  if (n == 0) return 0;
  set_matrix(b, n, S, SHB_TWO_PI * b->wave / b->cells);
  for (int i = 0; i < n; i++) {
    b->matrix[i * n + i] -= shift;
    x[i] = cexp(I * i * i);
  }
  if (LAPACKE_zgetrf_work(LAPACK_COL_MAJOR, n, n, b->matrix, n, b->pivot) != 0) return NAN;
  normalise(n, x);
  for (int step = 0; step < INVERSE_STEPS; step++) {
    double complex product = 0, before = lambda;
    for (int i = 0; i < n; i++) y[i] = x[i];
    LAPACKE_zgetrs_work(LAPACK_COL_MAJOR, 'N', n, 1, b->matrix, n, b->pivot, y, n);
    for (int i = 0; i < n; i++) product += conj(x[i]) * y[i];
    lambda = shift + 1 / product;
    if (!(normalise(n, y) > 0)) return NAN;
    for (int i = 0; i < n; i++) x[i] = y[i];
    if (step > 0 && cabs(lambda - before) < SETTLED * cabs(lambda)) break;
  }
  return pow(cabs(lambda), n_segments);
}
