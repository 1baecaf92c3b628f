#include "fem/supernodal/lower_blocks.h"

#include <cblas.h>
#include <string.h>

enum { BLOCK = 256 }; /* columns */

static const double MANY = 5e7; /* multiplications that are worth several threads */

/* Block b holds columns b BLOCK .. of rows b BLOCK .. n - 1. */
static size_t begin_of(int n, int b) {
  const size_t before = (size_t)b * BLOCK;
  return before * (size_t)n - before * (before > 0 ? before - BLOCK : 0) / 2;
}

size_t fem_lower_numbers(int n) {
  const int last = n > 0 ? (n - 1) / BLOCK : 0;
  return begin_of(n, last) + (size_t)(n - last * BLOCK) * (size_t)(n - last * BLOCK);
}

/* Leading dimension of a block. */
static int rows_of(const fem_lower *Q, int b) {
  return Q->n - b * BLOCK;
}

static double *entry_of(const fem_lower *Q, int i, int j) {
  const int b = j / BLOCK;
  return Q->at + begin_of(Q->n, b) + (size_t)(j - b * BLOCK) * (size_t)rows_of(Q, b) +
         (size_t)(i - b * BLOCK);
}

double *fem_lower_column(const fem_lower *Q, int j) {
  return entry_of(Q, Q->skip + j, Q->skip + j) - j;
}

static void add_to_block(const fem_lower *Q, int b, int k, const double *E, const double *Z) {
  const int     size = Q->n - Q->skip, ld = rows_of(Q, b);
  const int     from = b * BLOCK > Q->skip ? b * BLOCK : Q->skip;
  const int     end = (b + 1) * BLOCK < Q->n ? (b + 1) * BLOCK : Q->n, width = end - from;
  const double *own[2] = {E + (from - Q->skip), Z + (from - Q->skip)};
  const double *low[2] = {E + (end - Q->skip), Z + (end - Q->skip)};
  cblas_dsyr2k(CblasColMajor, CblasLower, CblasNoTrans, width, k, 0.5, own[0], size, own[1], size,
               1, entry_of(Q, from, from), ld);
  for (int i = 0; i < 2 && end < Q->n; i++)
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, Q->n - end, width, k, 0.5, low[i], size,
                own[1 - i], size, 1, entry_of(Q, end, from), ld);
}

void fem_lower_add_products(const fem_lower *Q, int k, const double *E, const double *Z) {
  const int    first = Q->skip / BLOCK, end = (Q->n + BLOCK - 1) / BLOCK;
  const double size = Q->n - Q->skip;
#pragma omp parallel for schedule(dynamic, 1) if (k * size * size > MANY)
  for (int b = first; b < end; b++) add_to_block(Q, b, k, E, Z);
}

void fem_lower_multiply(const fem_lower *Q, int count, const double *x, double *y) {
  const size_t c = (size_t)count;
  memset(y, 0, (size_t)(Q->n - Q->skip) * c * sizeof *y);
  for (int j = Q->skip, end; j < Q->n; j = end) {
    end                = (j / BLOCK + 1) * BLOCK < Q->n ? (j / BLOCK + 1) * BLOCK : Q->n;
    const int    width = end - j, below = Q->n - end, ld = rows_of(Q, j / BLOCK);
    const size_t own = (size_t)(j - Q->skip) * c, low = (size_t)(end - Q->skip) * c;
    cblas_dsymm(CblasColMajor, CblasRight, CblasLower, count, width, 1, entry_of(Q, j, j), ld,
                x + own, count, 1, y + own, count);
    if (below == 0) continue;
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, count, below, width, 1, x + own, count,
                entry_of(Q, end, j), ld, 1, y + low, count);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, count, width, below, 1, x + low, count,
                entry_of(Q, end, j), ld, 1, y + own, count);
  }
}
