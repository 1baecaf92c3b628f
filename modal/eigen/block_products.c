#include "modal/eigen/block_products.h"

#include <stdlib.h>
#include <string.h>

#include "fem/supernodal/hot.h"
#include "mesh/base/memory.h"

/* PARTS: sums of rows that are made apart. CHUNK: rows that stay in the cache. */
enum { PARTS = 32, CHUNK = 4096, LANES = 4, TOGETHER = 4 };

typedef double lanes __attribute__((vector_size(8 * LANES), aligned(8)));

FEM_KERNEL double sum_of(const lanes *v) {
  return ((*v)[0] + (*v)[1]) + ((*v)[2] + (*v)[3]);
}

/* out[c] += x . y_c for TOGETHER columns. */
FEM_KERNEL void add_dots(size_t rows, const double *x, const double *y, size_t ld, size_t p,
                         double *out) {
  lanes        s0 = {0}, s1 = s0, s2 = s0, s3 = s0;
  const size_t whole = rows / LANES * LANES;
  for (size_t i = 0; i < whole; i += LANES) {
    const lanes v = *(const lanes *)(x + i);
    s0 += v * *(const lanes *)(y + i);
    s1 += v * *(const lanes *)(y + ld + i);
    s2 += v * *(const lanes *)(y + 2 * ld + i);
    s3 += v * *(const lanes *)(y + 3 * ld + i);
  }
  double rest[TOGETHER] = {0};
  for (size_t i = whole; i < rows; i++)
    for (size_t c = 0; c < TOGETHER; c++) rest[c] += x[i] * y[c * ld + i];
  const double sum[TOGETHER] = {sum_of(&s0), sum_of(&s1), sum_of(&s2), sum_of(&s3)};
  for (size_t c = 0; c < TOGETHER; c++) out[c * p] += sum[c] + rest[c];
}

FEM_KERNEL void add_dot(size_t rows, const double *x, const double *y, double *out) {
  lanes        s     = {0};
  const size_t whole = rows / LANES * LANES;
  for (size_t i = 0; i < whole; i += LANES) s += *(const lanes *)(x + i) * *(const lanes *)(y + i);
  double rest = 0;
  for (size_t i = whole; i < rows; i++) rest += x[i] * y[i];
  *out += sum_of(&s) + rest;
}

/* C += X^T Y of some rows. */
FEM_KERNEL void add_inner(size_t rows, size_t p, const double *X, const double *Y, size_t ld,
                          double *C) {
  const size_t whole = p / TOGETHER * TOGETHER;
  for (size_t a = 0; a < p; a++) {
    for (size_t c = 0; c < whole; c += TOGETHER)
      add_dots(rows, X + a * ld, Y + c * ld, ld, p, C + c * p + a);
    for (size_t c = whole; c < p; c++) add_dot(rows, X + a * ld, Y + c * ld, C + c * p + a);
  }
}

/* Rows begin .. end - 1, all blocks. */
FEM_HOT static void add_part(size_t begin, size_t end, size_t rows, size_t p, size_t n,
                             double *const *Q, const double *Y, double *C) {
  for (size_t at = begin; at < end; at += CHUNK) {
    const size_t count = end - at < CHUNK ? end - at : CHUNK;
    for (size_t k = 0; k < n; k++) add_inner(count, p, Q[k] + at, Y + at, rows, C + k * p * p);
  }
}

void modal_block_inner(size_t rows, size_t p, size_t n, double *const *Q, const double *Y,
                       double *C) {
  const size_t size = n * p * p, each = (rows / PARTS / CHUNK + 1) * CHUNK;
  double      *parts = shb_alloc_zeroed(PARTS * size + 1, sizeof *parts);
#pragma omp parallel for schedule(static)
  for (size_t part = 0; part < PARTS; part++) {
    const size_t begin = part * each, end = begin + each < rows ? begin + each : rows;
    if (begin < rows) add_part(begin, end, rows, p, n, Q, Y, parts + part * size);
  }
  memset(C, 0, size * sizeof *C);
  for (size_t part = 0; part < PARTS; part++)
    for (size_t i = 0; i < size; i++) C[i] += parts[part * size + i];
  free(parts);
}

/* w -= sum of q_a weight_a */
FEM_KERNEL void subtract_columns(size_t rows, size_t p, const double *Q, size_t ld,
                                 const double *weight, double *w) {
  size_t a = 0;
  for (; a + TOGETHER <= p; a += TOGETHER) {
    const double *q = Q + a * ld, *s = weight + a;
    const size_t  whole = rows / LANES * LANES;
    for (size_t i = 0; i < whole; i += LANES)
      *(lanes *)(w + i) -=
          (*(const lanes *)(q + i) * s[0] + *(const lanes *)(q + ld + i) * s[1]) +
          (*(const lanes *)(q + 2 * ld + i) * s[2] + *(const lanes *)(q + 3 * ld + i) * s[3]);
    for (size_t i = whole; i < rows; i++)
      w[i] -= (q[i] * s[0] + q[ld + i] * s[1]) + (q[2 * ld + i] * s[2] + q[3 * ld + i] * s[3]);
  }
  for (; a < p; a++)
    for (size_t i = 0; i < rows; i++) w[i] -= Q[a * ld + i] * weight[a];
}

/* Of count rows from at on. */
FEM_HOT static void subtract_chunk(size_t at, size_t count, size_t rows, size_t p, size_t n,
                                   double *const *Q, const double *C, double *W) {
  for (size_t k = 0; k < n; k++)
    for (size_t c = 0; c < p; c++)
      subtract_columns(count, p, Q[k] + at, rows, C + (k * p + c) * p, W + c * rows + at);
}

void        modal_block_subtract(size_t rows, size_t p, size_t n, double *const *Q, const double *C,
                                 double *W) {
#pragma omp parallel for schedule(static)
  for (size_t at = 0; at < rows; at += CHUNK) {
    const size_t count = rows - at < CHUNK ? rows - at : CHUNK;
    subtract_chunk(at, count, rows, p, n, Q, C, W);
  }
}
