#include "mhb/balance/ring_system.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* ---- life cycle ---- */

mhb_ring_system *mhb_ring_system_create(const mhb_balance *b) {
  const mhb_ring_receptance *ring = b->receptance->ring;
  const size_t               n = (size_t)b->n, pairs = (size_t)b->n_pairs, axes = 3 * (size_t)b->nb;
  const size_t               all = ((size_t)b->m + 1) * 3 * pairs;
  mhb_ring_system           *s   = shb_alloc_zeroed(1, sizeof *s);
  s->balance                     = b;
  s->kind                        = shb_arena_take(&s->arena, pairs, sizeof *s->kind);
  s->law                         = shb_arena_take(&s->arena, pairs, sizeof *s->law);
  s->D                           = shb_arena_take(&s->arena, pairs * axes * axes, sizeof(double));
  s->line                        = shb_arena_take(&s->arena, 2 * axes, sizeof(double));
  s->reduced                     = shb_arena_take(&s->arena, n + 1, sizeof(double));
  s->column                      = shb_arena_take(&s->arena, all, sizeof(double complex));
  s->row                         = shb_arena_take(&s->arena, all, sizeof(double complex));
  s->x                           = shb_arena_take(&s->arena, all, sizeof(double complex));
  s->q                           = shb_arena_take(&s->arena, all, sizeof(double complex));
  s->blocks                      = mhb_block_cyclic_create(ring->blades, ring->n * b->nb);
  s->linear                      = mhb_ring_condensation_create(ring, b->m);
  return s;
}

void mhb_ring_system_destroy(mhb_ring_system *s) {
  if (!s) return;
  mhb_block_cyclic_destroy(s->blocks);
  mhb_ring_condensation_destroy(s->linear);
  shb_arena_free(&s->arena);
  free(s);
}

/* ---- vectors: real form [3 pairs][nb] and harmonics [k][3 pairs] ---- */

static int n_axes(const mhb_ring_system *s) {
  return 3 * s->balance->n_pairs;
}

static void to_harmonics(const mhb_ring_system *s, const double *x, double complex *X) {
  const int axes = n_axes(s), nb = s->balance->nb;
  for (int i = 0; i < axes; i++, x += nb) {
    X[i] = x[0];
    for (int k = 1; k <= s->balance->m; k++) X[k * axes + i] = CMPLX(x[2 * k - 1], x[2 * k]);
  }
}

/* Rows of a contact alone. */
static void to_real(const mhb_ring_system *s, int contact, const double complex *X, double *x) {
  const int axes = n_axes(s), nb = s->balance->nb, n = s->linear->n;
  for (int i = contact * n; i < (contact + 1) * n; i++, x += nb) {
    x[0] = creal(X[i]);
    for (int k = 1; k <= s->balance->m; k++) {
      x[2 * k - 1] = creal(X[k * axes + i]);
      x[2 * k]     = cimag(X[k * axes + i]);
    }
  }
}

static void conjugate(int n, double complex *x) {
  for (int i = 0; i < n; i++) x[i] = conj(x[i]);
}

/* ---- factors ---- */

/* Columns of a pair in a block: rows R[n][n] of harmonic k, from the pair's first, times its dp. */
static void add_harmonic(mhb_ring_system *s, int pair, int k, const double complex *R,
                         mhb_cyclic_block block) {
  const int n = s->linear->n, nb = s->balance->nb, stride = block.stride;
  double   *to = block.at + (k ? 2 * k - 1 : 0) * stride;
  for (int row = 0; row < n; row++, R += n, to += nb * stride)
    mhb_balance_row_times_dp(s->balance, R, pair, k, to, to + stride);
}

/* The block of R D with the row contact b and the column contact c, both left, is added to
 * block. */
static void add_block(mhb_ring_system *s, int b, int c, double complex *R, mhb_cyclic_block block) {
  const int P = s->linear->n / 3, axes = 3 * s->balance->nb;
  for (int j = 0; j < P; j++) {
    const int              pair = c * P + j;
    const mhb_cyclic_block to   = {block.at + j * axes, block.stride};
    if (s->kind[pair] == MHB_PAIR_OPEN) continue;
    for (int k = 0; k <= s->balance->m; k++)
      add_harmonic(s, pair, k, mhb_ring_condensation_at(s->linear, R, k, b) + 3 * (size_t)j, to);
  }
}

static void assemble(mhb_ring_system *s) {
  mhb_block_cyclic            *f = s->blocks;
  const mhb_ring_condensation *l = s->linear;
  const int                    N = l->n_left;
  for (int i = 0; i < N; i++) {
    const int              b   = l->left[i];
    const mhb_cyclic_block own = mhb_block_cyclic_at(f, MHB_BLOCK_OWN, i);
    add_block(s, b, b, l->own, own);
    for (int j = 0; j < f->size; j++) own.at[j * (own.stride + 1)] += 1;
    if (N == 1) continue;
    add_block(s, b, l->left[(i + N - 1) % N], l->to_before,
              mhb_block_cyclic_at(f, MHB_BLOCK_BEFORE, i));
    add_block(s, b, l->left[(i + 1) % N], l->to_after, mhb_block_cyclic_at(f, MHB_BLOCK_AFTER, i));
  }
}

/* The border of the contacts left, and its corner, without those gone. */
static void set_border(mhb_ring_system *s, const double *column, const double *row) {
  mhb_block_cyclic      *f = s->blocks;
  mhb_ring_condensation *l = s->linear;
  const int axes = n_axes(s), K = s->balance->m + 1, P = l->n / 3, own = 3 * s->balance->nb;
  double    corner = row[s->balance->n];
  to_harmonics(s, column, s->column);
  to_harmonics(s, row, s->row);
  conjugate(K * axes, s->row); /* Re(w x) = row . x */
  for (int k = 0; k < K; k++) {
    double complex *c = s->column + k * axes, *w = s->row + k * axes;
    mhb_ring_condensation_functional(l, k, w, s->q + k * axes);
    mhb_ring_condensation_forward(l, k, c);
    for (int g = 0; g < l->n_gone; g++)
      for (int j = l->gone[g] * l->n; j < (l->gone[g] + 1) * l->n; j++)
        corner -= creal(w[j]) * creal(c[j]) - cimag(w[j]) * cimag(c[j]);
  }
  s->corner = f->corner = corner;
  for (int i = 0; i < l->n_left; i++) {
    const int b  = l->left[i];
    double   *to = f->row + i * f->size;
    to_real(s, b, s->column, f->column + i * f->size);
    memcpy(to, row + b * f->size, sizeof *to * (size_t)f->size);
    for (int j = 0; j < P; j++, to += own)
      for (int k = 0; k < K; k++) {
        double *im = s->line + own;
        mhb_balance_row_times_dp(s->balance, s->q + k * axes + 3 * (b * P + j), b * P + j, k, to,
                                 im);
      }
  }
}

/* What solutions need of the evaluation, which may change before they are asked for. */
static void keep_laws(mhb_ring_system *s) {
  const mhb_balance *b     = s->balance;
  const size_t       pairs = (size_t)b->n_pairs, block = 9 * (size_t)b->nb * (size_t)b->nb;
  memcpy(s->kind, b->eval->kind, sizeof *s->kind * pairs);
  memcpy(s->law, b->law, sizeof *s->law * pairs);
  for (size_t a = 0; a < pairs; a++)
    if (!mhb_ring_contact_is_linear(s->kind, s->linear->n / 3, 3 * (int)a / s->linear->n))
      memcpy(s->D + a * block, b->eval->dp + a * block, sizeof(double) * block);
}

int mhb_ring_system_factor(mhb_ring_system *s, const double *column, const double *row) {
  mhb_block_cyclic *f = s->blocks;
  s->regular          = 0;
  s->borders          = column != NULL;
  for (int k = 0; k <= s->balance->m; k++) mhb_receptance_update(s->balance->receptance, k);
  keep_laws(s);
  if (!mhb_ring_condensation_factor(s->linear, s->law, s->kind, 0)) return 0;
  f->blocks = s->linear->n_left;
  mhb_block_cyclic_clear(f);
  if (column) set_border(s, column, row);
  assemble(s);
  s->regular =
      f->blocks > 0 ? mhb_block_cyclic_factor(f, s->borders) : s->borders == 0 || s->corner != 0;
  return s->regular;
}

/* ---- solutions ---- */

/* q of a contact left <- D x, x its unknowns. */
static void set_force(mhb_ring_system *s, int contact, const double *x) {
  const int P = s->linear->n / 3, axes = n_axes(s), nb = s->balance->nb, own = 3 * nb;
  double    force[own];
  for (int a = contact * P; a < (contact + 1) * P; a++, x += own) {
    cblas_dgemv(CblasRowMajor, CblasNoTrans, own, own, 1,
                s->D + (size_t)a * (size_t)own * (size_t)own, own, x, 1, 0, force, 1);
    for (int i = 0; i < 3; i++) {
      s->q[3 * a + i] = force[i * nb];
      for (int k = 1; k <= s->balance->m; k++)
        s->q[k * axes + 3 * a + i] = CMPLX(force[i * nb + 2 * k - 1], force[i * nb + 2 * k]);
    }
  }
}

/* Harmonics of the right-hand side without the contacts gone. Returns their part of the border. */
static double condense(mhb_ring_system *s, const double *rhs) {
  const mhb_ring_condensation *l    = s->linear;
  const int                    axes = n_axes(s);
  double                       part = 0;
  to_harmonics(s, rhs, s->x);
  for (int k = 0; k <= s->balance->m; k++) {
    const double complex *x = s->x + k * axes, *w = s->row + k * axes;
    mhb_ring_condensation_forward(s->linear, k, s->x + k * axes);
    for (int g = 0; s->borders && g < l->n_gone; g++)
      for (int j = l->gone[g] * l->n; j < (l->gone[g] + 1) * l->n; j++)
        part += creal(w[j]) * creal(x[j]) - cimag(w[j]) * cimag(x[j]);
  }
  return part;
}

/* The contacts gone, from those left. */
static void expand(mhb_ring_system *s, double sigma) {
  const mhb_ring_condensation *l    = s->linear;
  const int                    axes = n_axes(s);
  for (int k = 0; k <= s->balance->m; k++) {
    double complex       *x = s->x + k * axes;
    const double complex *c = s->column + k * axes;
    for (int g = 0; sigma != 0 && g < l->n_gone; g++)
      for (int j = l->gone[g] * l->n; j < (l->gone[g] + 1) * l->n; j++) x[j] -= sigma * c[j];
    mhb_ring_condensation_backward(s->linear, k, x, s->q + k * axes);
  }
}

static void solve_condensed(mhb_ring_system *s, double *rhs) {
  const mhb_ring_condensation *l    = s->linear;
  const int                    size = s->blocks->size, left = l->n_left * size;
  const double                 part = condense(s, rhs);
  for (int i = 0; i < l->n_left; i++) to_real(s, l->left[i], s->x, s->reduced + i * size);
  if (s->borders) s->reduced[left] = rhs[s->balance->n] - part;
  if (l->n_left > 0)
    mhb_block_cyclic_solve(s->blocks, s->reduced);
  else if (s->borders)
    s->reduced[left] /= s->corner;
  for (int i = 0; i < l->n_left; i++) set_force(s, l->left[i], s->reduced + i * size);
  expand(s, s->borders ? s->reduced[left] : 0);
  for (int g = 0; g < l->n_gone; g++) to_real(s, l->gone[g], s->x, rhs + l->gone[g] * size);
  for (int i = 0; i < l->n_left; i++)
    memcpy(rhs + l->left[i] * size, s->reduced + i * size, sizeof *rhs * (size_t)size);
  if (s->borders) rhs[s->balance->n] = s->reduced[left];
}

int mhb_ring_system_solve(mhb_ring_system *s, double *rhs) {
  if (!s->regular) return 0;
  if (s->linear->n_gone == 0)
    mhb_block_cyclic_solve(s->blocks, rhs);
  else
    solve_condensed(s, rhs);
  for (int i = 0; i < s->balance->n + s->borders; i++)
    if (!isfinite(rhs[i])) return 0;
  return 1;
}

int mhb_ring_system_sign(const mhb_ring_system *s) {
  if (s->linear->n_left > 0) return s->blocks->sign;
  return s->borders && s->corner < 0 ? -1 : 1;
}
