#include "modal/cyclic/wave_basis.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/supernodal/large_pages.h"
#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "modal/common/random_vector.h"
#include "modal/cyclic/small_hermitian.h"

static const double complex one = 1;

void wave_basis_create(wave_operator *op, int p, int capacity, wave_basis *b) {
  const size_t block = (size_t)p * op->order, each = (size_t)p * (size_t)p;
  const size_t blocks = (size_t)capacity, m = (size_t)p * blocks;
  *b       = (wave_basis){.op = op, .order = op->order, .p = p, .capacity = capacity};
  b->W     = fem_large_alloc(block, sizeof *b->W);
  b->MW    = fem_large_alloc(block, sizeof *b->MW);
  b->Q     = fem_large_alloc(blocks * block, sizeof *b->Q); /* touched as it grows */
  b->D     = shb_alloc_zeroed(blocks * each, sizeof *b->D);
  b->B     = shb_alloc_zeroed(blocks * each, sizeof *b->B);
  b->H     = shb_alloc(m * m, sizeof *b->H);
  b->theta = shb_alloc(m, sizeof *b->theta);
  b->C     = shb_alloc((size_t)p * m, sizeof *b->C);
}

void wave_basis_free(wave_basis *b) {
  void *part[] = {b->W, b->MW, b->Q, b->D, b->B, b->H, b->theta, b->C};
  for (size_t i = 0; i < sizeof part / sizeof *part; i++) free(part[i]);
  memset(b, 0, sizeof *b);
}

/* Complex number whose parts are normally distributed (Box and Muller 1958). */
static double complex normal(uint64_t key) {
  const double u = (modal_random(2 * key) + 1) / 2, v = modal_random(2 * key + 1);
  const double size = sqrt(-log(1 - u));
  return CMPLX(size * cos(SHB_PI * v), size * sin(SHB_PI * v));
}

void wave_basis_randomise(const wave_basis *b, uint64_t seed) {
  const size_t size = (size_t)b->p * b->order;
  for (size_t i = 0; i < size; i++) {
    const double complex z = normal(seed * size + i);
    b->W[i]                = b->op->is_real ? sqrt(2) * creal(z) : z;
  }
}

void wave_basis_project_out(wave_basis *b, double complex *last) {
  const int m = b->p * b->n;
  wave_operator_mass(b->op, b->p, b->W, b->MW);
  wave_inner(b->order, m, b->Q, b->p, b->MW, b->C);
  wave_add(b->order, -1, m, b->Q, b->C, b->p, b->W);
  for (int c = 0; last && b->n > 0 && c < b->p; c++)
    for (int r = 0; r < b->p; r++) last[c * b->p + r] += b->C[c * m + m - b->p + r];
}

/* P = R P; R is upper triangular, both by columns. */
static void multiply_triangle(int p, const double complex *R, double complex *P) {
  for (int c = 0; c < p; c++)
    for (int r = 0; r < p; r++) {
      double complex sum = 0;
      for (int i = r; i < p; i++) sum += R[i * p + r] * P[c * p + i];
      P[c * p + r] = sum;
    }
}

void wave_basis_cholesky_qr(wave_basis *b, double complex *product, bool *good) {
  const int       p = b->p, n = (int)b->order;
  double complex *R = b->C;
  wave_inner(b->order, p, b->W, p, b->MW, R);
  *good = small_hermitian_cholesky(p, R);
  if (!*good) return;
  cblas_ztrsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, n, p, &one, R, p,
              b->W, n);
  cblas_ztrsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, n, p, &one, R, p,
              b->MW, n);
  multiply_triangle(p, R, product);
}

/* The second pass removes rounding errors only (modal/eigen/block_basis.c). */
void wave_basis_orthonormalise(wave_basis *b, double complex *D, double complex *R, bool *good) {
  *good = true;
  for (int i = 0; i < b->p * b->p; i++) R[i] = i % (b->p + 1) == 0;
  for (int pass = 0; pass < (b->n > 0 ? 2 : 1); pass++) wave_basis_project_out(b, D);
  for (int pass = 0; pass < 2 && *good; pass++) wave_basis_cholesky_qr(b, R, good);
}

void wave_basis_append(wave_basis *b) {
  const size_t block = (size_t)b->p * b->order;
  memcpy(b->Q + (size_t)b->n++ * block, b->W, block * sizeof *b->Q);
}

void wave_basis_projection(int p, int n, const double complex *D, const double complex *B,
                           double complex *H) {
  const size_t each = (size_t)p * (size_t)p, m = (size_t)p * (size_t)n;
  memset(H, 0, m * m * sizeof *H);
  for (int k = 0; k < n; k++, D += each, B += each)
    for (int c = 0; c < p; c++)
      for (int r = 0; r < p; r++) {
        double complex *column = H + (size_t)(k * p + c) * m + k * p;
        column[r]              = (D[c * p + r] + conj(D[r * p + c])) / 2;
        if (k + 1 < n) column[p + r] = B[c * p + r];
      }
}
