#include "mhb/floquet/bloch.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

/* An imaginary part below this share of the modulus is the rounding of a power. */
static const double REAL = 1e-11;

shb_status mhb_bloch_create(int cells, int capacity, mhb_bloch *b) {
  size_t n = (size_t)capacity, square = n * n;
  *b      = (mhb_bloch){.cells = cells, .capacity = capacity, .size = 34 * capacity};
  b->real = calloc(square + 1, sizeof *b->real);
  b->re   = calloc(n + 1, sizeof *b->re);
  b->im   = calloc(n + 1, sizeof *b->im);
  b->work = calloc((size_t)b->size + 2 * n + 1, sizeof *b->work);
  if (cells > 2) b->matrix = calloc(square + 1, sizeof *b->matrix);
  if (cells > 2) b->value = calloc(n + 1, sizeof *b->value);
  if (b->real && b->re && b->im && b->work && (cells <= 2 || (b->matrix && b->value)))
    return SHB_OK;
  mhb_bloch_destroy(b);
  SHB_FAIL(SHB_ERR_IO, "out of memory for the multipliers of %d states", capacity);
}

void mhb_bloch_destroy(mhb_bloch *b) {
  free(b->real);
  free(b->re);
  free(b->im);
  free(b->matrix);
  free(b->value);
  free(b->work);
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

/* Other kappa: complex. */
static int complex_problem(mhb_bloch *b, int n, const double *S, double kappa) {
  int square = n * n;
  for (int i = 0; i < square; i++) b->matrix[i] = S[i];
  for (int c = 1; c < b->cells; c++) {
    double complex turn = cexp(-I * kappa * c);
    for (int i = 0; i < square; i++) b->matrix[i] += turn * S[c * square + i];
  }
  return LAPACKE_zgeev_work(LAPACK_COL_MAJOR, 'N', 'N', n, b->matrix, n, b->value, NULL, 1, NULL, 1,
                            (double complex *)b->work, b->size / 2, b->work + b->size) == 0;
}

int mhb_bloch_multipliers(mhb_bloch *b, int n, const double *S, int n_segments, int cell_shift,
                          double complex *multiplier) {
  int g = b->cells, done = 0;
  if (n == 0) return 1;
  for (int l = 0; 2 * l <= g; l++) {
    double kappa = SHB_TWO_PI * l / g;
    int    own   = l == 0 || 2 * l == g; /* its own conjugate */
    if (!(own ? real_problem(b, n, S, l > 0, multiplier + done) : complex_problem(b, n, S, kappa)))
      return 0;
    double complex turn = own ? (l > 0 && cell_shift % 2 ? -1 : 1) : cexp(-I * kappa * cell_shift);
    for (int i = 0; i < n && own; i++, done++)
      multiplier[done] = turn * power(multiplier[done], n_segments);
    for (int i = 0; i < n && !own; i++, done += 2) {
      multiplier[done]     = turn * power(b->value[i], n_segments);
      multiplier[done + 1] = conj(multiplier[done]);
    }
  }
  return 1;
}
