#include "mhb/variation/ring_band.h"

#include <math.h>
#include <stdlib.h>

static int least(int a, int b) {
  return a < b ? a : b;
}

void mhb_ring_band_create(int blades, int block, mhb_ring_band *b) {
  int n    = blades * block;
  *b       = (mhb_ring_band){.n = n, .block = block, .blades = blades};
  b->width = least(3 * block - 1, n - 1);
  b->row   = shb_arena_take(&b->arena, (size_t)n * (size_t)(3 * b->width + 1), sizeof *b->row);
  b->pivot = shb_arena_take(&b->arena, (size_t)n, sizeof *b->pivot);
  b->place = shb_arena_take(&b->arena, (size_t)n, sizeof *b->place);
  for (int i = 0; i < n; i++) {
    int blade = i / block, folded = 2 * blade < blades ? 2 * blade : 2 * (blades - blade) - 1;
    b->place[i] = folded * block + i % block;
  }
}

void mhb_ring_band_destroy(mhb_ring_band *b) {
  shb_arena_free(&b->arena);
  *b = (mhb_ring_band){0};
}

int mhb_ring_band_neighbours(const mhb_ring_band *b, int blade, int neighbour[3]) {
  int n = 0;
  for (int step = -1; step <= 1 && n < b->blades; step++)
    neighbour[n++] = (blade + step + b->blades) % b->blades;
  return n;
}

void mhb_ring_band_clear(mhb_ring_band *b) {
  memset(b->row, 0, sizeof *b->row * (size_t)b->n * (size_t)(3 * b->width + 1));
}

/* Rows are exchanged from column k on only, as in dgbtrf: the factors of earlier columns stay. */
int mhb_ring_band_factor(mhb_ring_band *b) {
  int w = b->width, next = 3 * w; /* from an entry to the one below it */
  for (int k = 0; k < b->n; k++) {
    double *top = b->row + (long)k * (3 * w + 1) + w, *best = top;
    int     below = least(w, b->n - 1 - k), right = least(2 * w, b->n - 1 - k), p = 0;
    for (int i = 1; i <= below; i++)
      if (fabs(top[i * next]) > fabs(*best)) best = top + (p = i) * next;
    b->pivot[k] = k + p;
    if (!(fabs(*best) > 1e-300)) return 0;
    for (int j = 0; p && j <= right; j++) {
      double swap = top[j];
      top[j]      = best[j];
      best[j]     = swap;
    }
    *top = 1 / *top;
    for (int i = 1; i <= below; i++) {
      double *other = top + i * next, l = other[0] *= *top;
      for (int j = 1; l != 0 && j <= right; j++) other[j] -= l * top[j];
    }
  }
  return 1;
}

MHB_INLINE void solve(int n, int w, const double *row, const int *pivot, mhb_columns *x) {
  int next = 3 * w;
  for (int k = 0; k < n; k++) {
    const double *top = row + (long)k * (next + 1) + w;
    mhb_columns   xk  = x[pivot[k]];
    x[pivot[k]]       = x[k];
    x[k]              = xk;
    for (int i = 1; i <= w && k + i < n; i++) x[k + i] -= top[i * next] * xk;
  }
  for (int k = n - 1; k >= 0; k--) {
    const double *top = row + (long)k * (next + 1) + w;
    mhb_columns   sum = x[k], odd = {0}; /* two sums: each waits for its last addition */
    for (int j = 2; j <= 2 * w && k + j < n; j += 2) sum -= top[j] * x[k + j];
    for (int j = 1; j < 2 * w && k + j < n; j += 2) odd -= top[j] * x[k + j];
    x[k] = (sum + odd) * top[0];
  }
}

MHB_HOT static void solve_one(const mhb_ring_band *b, mhb_columns *x) {
  solve(3, 2, b->row, b->pivot, x);
}

MHB_HOT static void solve_folded(const mhb_ring_band *b, mhb_columns *x, mhb_columns *folded) {
  for (int i = 0; i < b->n; i++) folded[b->place[i]] = x[i];
  if (b->width == 8) { /* blocks of three */
    solve(b->n, 8, b->row, b->pivot, folded);
  } else {
    solve(b->n, b->width, b->row, b->pivot, folded);
  }
  for (int i = 0; i < b->n; i++) x[i] = folded[b->place[i]];
}

void mhb_ring_band_solve(const mhb_ring_band *b, mhb_columns *x, mhb_columns *folded) {
  if (b->n == 3) {
    solve_one(b, x);
  } else {
    solve_folded(b, x, folded);
  }
}
