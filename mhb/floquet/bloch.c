#include "mhb/floquet/bloch.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

/* An imaginary part this small beside the modulus is the rounding of a power. */
static const double REAL = 1e-11;

shb_status mhb_bloch_create(int cells, int room, mhb_bloch *b) {
  size_t n = (size_t)room, square = n * n;
  *b      = (mhb_bloch){.cells = cells, .room = room, .size = 34 * room};
  b->real = calloc(square + 1, sizeof *b->real);
  b->re   = calloc(n + 1, sizeof *b->re);
  b->im   = calloc(n + 1, sizeof *b->im);
  b->work = calloc((size_t)b->size + 2 * n + 1, sizeof *b->work);
  if (cells > 2) b->matrix = calloc(square + 1, sizeof *b->matrix);
  if (cells > 2) b->value = calloc(n + 1, sizeof *b->value);
  if (b->real && b->re && b->im && b->work && (cells <= 2 || (b->matrix && b->value)))
    return SHB_OK;
  mhb_bloch_destroy(b);
  SHB_FAIL(SHB_ERR_IO, "out of memory for the multipliers of %d states", room);
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

/* kappa = 0 or pi: the sum is real, and so is the turn. */
static int in_phase(mhb_bloch *b, int n, const double *S, int alternate, double complex *value) {
  int square = n * n;
  memcpy(b->real, S, sizeof *S * (size_t)square);
  for (int c = 1; c < b->cells; c++)
    for (int i = 0; i < square; i++)
      b->real[i] += alternate && c % 2 ? -S[c * square + i] : S[c * square + i];
  if (LAPACKE_dgeev_work(LAPACK_COL_MAJOR, 'N', 'N', n, b->real, n, b->re, b->im, NULL, 1, NULL, 1,
                         b->work, b->size) != 0)
    return 0;
  for (int i = 0; i < n; i++) value[i] = CMPLX(b->re[i], b->im[i]);
  return 1;
}

static int travelling(mhb_bloch *b, int n, const double *S, double kappa) {
  int square = n * n;
  for (int i = 0; i < square; i++) b->matrix[i] = S[i];
  for (int c = 1; c < b->cells; c++) {
    double complex turn = cexp(-I * kappa * c);
    for (int i = 0; i < square; i++) b->matrix[i] += turn * S[c * square + i];
  }
  return LAPACKE_zgeev_work(LAPACK_COL_MAJOR, 'N', 'N', n, b->matrix, n, b->value, NULL, 1, NULL, 1,
                            (double complex *)b->work, b->size / 2, b->work + b->size) == 0;
}

int mhb_bloch_multipliers(mhb_bloch *b, int n, const double *S, int chunks, int names,
                          double complex *multiplier) {
  int g = b->cells, done = 0;
  if (n == 0) return 1;
  for (int l = 0; 2 * l <= g; l++) {
    double kappa = SHB_TWO_PI * l / g;
    int    own   = l == 0 || 2 * l == g; /* its own conjugate */
    if (!(own ? in_phase(b, n, S, l > 0, multiplier + done) : travelling(b, n, S, kappa))) return 0;
    double complex turn = own ? (l > 0 && names % 2 ? -1 : 1) : cexp(-I * kappa * names);
    for (int i = 0; i < n && own; i++, done++)
      multiplier[done] = turn * power(multiplier[done], chunks);
    for (int i = 0; i < n && !own; i++, done += 2) {
      multiplier[done]     = turn * power(b->value[i], chunks);
      multiplier[done + 1] = conj(multiplier[done]);
    }
  }
  return 1;
}
