#include "mhb/balance/ring_system.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/structure/ring_receptance.h"

shb_status mhb_ring_system_create(const mhb_balance *b, mhb_ring_system **out) {
  const mhb_ring_receptance *ring = b->receptance->ring;
  mhb_ring_system           *s    = calloc(1, sizeof *s);
  SHB_CHECK(s, SHB_ERR_IO, "out of memory");
  s->balance        = b;
  s->row            = shb_arena_take(&s->arena, 6 * (size_t)b->nb, sizeof(double));
  shb_status status = mhb_block_cyclic_create(ring->blades, ring->n * b->nb, &s->blocks);
  if (status == SHB_OK && s->arena.failed)
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status != SHB_OK) {
    mhb_ring_system_destroy(s);
    return status;
  }
  *out = s;
  return SHB_OK;
}

void mhb_ring_system_destroy(mhb_ring_system *s) {
  if (!s) return;
  mhb_block_cyclic_destroy(s->blocks);
  shb_arena_free(&s->arena);
  free(s);
}

/* Columns of a pair in a block: rows R[n][n] of harmonic k, from the pair's first, times its dp. */
static void add_harmonic(mhb_ring_system *s, int pair, int k, const double complex *R, double *to) {
  const int n = s->balance->receptance->ring->n, nb = s->balance->nb, axes = 3 * nb;
  const int size = s->blocks->size;
  double   *re = s->row, *im = re + axes;
  to += k ? 2 * k - 1 : 0;
  for (int row = 0; row < n; row++, R += n, to += nb) {
    memset(re, 0, 2 * sizeof *re * (size_t)axes);
    mhb_balance_row_times_dp(s->balance, R, pair, k, re, im);
    for (int i = 0; i < axes; i++) {
      to[(size_t)i * (size_t)size] += re[i];
      if (k) to[(size_t)i * (size_t)size + 1] += im[i];
    }
  }
}

/* The block of R D with the row contact b and the column contact c, into block[s][s]. */
static void add_block(mhb_ring_system *s, int b, int c, mhb_ring_block which, double *block) {
  const mhb_ring_receptance *ring = s->balance->receptance->ring;
  const int                  P = ring->n / 3, axes = 3 * s->balance->nb;
  for (int j = 0; j < P; j++) {
    const int pair = c * P + j;
    double   *to   = block + (size_t)j * (size_t)axes * (size_t)s->blocks->size;
    if (s->balance->eval->kind[pair] == MHB_PAIR_OPEN) continue;
    for (int k = 0; k <= s->balance->m; k++)
      add_harmonic(s, pair, k, mhb_ring_receptance_block(ring, k, b, which) + 3 * (size_t)j, to);
  }
}

static void assemble(mhb_ring_system *s) {
  mhb_block_cyclic *f = s->blocks;
  const int         N = f->blocks;
  mhb_block_cyclic_clear(f);
  for (int b = 0; b < N; b++) {
    double *own = mhb_block_cyclic_at(f, f->own, b);
    add_block(s, b, b, MHB_RING_OWN, own);
    add_block(s, b, (b + N - 1) % N, MHB_RING_BEFORE, mhb_block_cyclic_at(f, f->before, b));
    add_block(s, b, (b + 1) % N, MHB_RING_AFTER, mhb_block_cyclic_at(f, f->after, b));
    for (int i = 0; i < f->size; i++) own[i * (f->size + 1)] += 1;
  }
}

int mhb_ring_system_factor(mhb_ring_system *s, const double *column, const double *row) {
  const size_t n = (size_t)s->balance->n;
  for (int k = 0; k <= s->balance->m; k++) mhb_receptance_update(s->balance->receptance, k);
  assemble(s);
  if (column) {
    memcpy(s->blocks->column, column, n * sizeof *column);
    memcpy(s->blocks->row, row, n * sizeof *row);
    s->blocks->corner = row[n];
  }
  s->regular = mhb_block_cyclic_factor(s->blocks, column != NULL);
  return s->regular;
}

int mhb_ring_system_solve(mhb_ring_system *s, double *rhs) {
  mhb_block_cyclic_solve(s->blocks, rhs);
  for (int i = 0; i < s->balance->n + s->blocks->borders; i++)
    if (!isfinite(rhs[i])) return 0;
  return 1;
}

int mhb_ring_system_sign(const mhb_ring_system *s) {
  return s->blocks->sign;
}
