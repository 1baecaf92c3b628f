#include "mhb/balance/ring_condensation.h"

#include <cblas.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/numerics/blas_room.h"
#include "mhb/numerics/lu.h"
#include "mhb/structure/relative_motion.h"

/* ---- life cycle ---- */

mhb_ring_condensation *mhb_ring_condensation_create(const mhb_ring_receptance *ring, int m) {
  mhb_ring_condensation *c = shb_alloc_zeroed(1, sizeof *c);
  const size_t N = (size_t)ring->blades, n = (size_t)ring->n, one = sizeof(double complex);
  const size_t all                = ((size_t)m + 1) * N * n * n;
  c->ring                         = ring;
  c->m                            = m;
  c->blades                       = ring->blades;
  c->n                            = ring->n;
  c->gone                         = shb_arena_take(&c->arena, N, sizeof(int));
  c->left                         = shb_arena_take(&c->arena, N, sizeof(int));
  c->before                       = shb_arena_take(&c->arena, N, sizeof(int));
  c->after                        = shb_arena_take(&c->arena, N, sizeof(int));
  double complex **const blocks[] = {&c->own,     &c->to_before,   &c->to_after,
                                     &c->inverse, &c->from_before, &c->from_after};
  for (int i = 0; i < 6; i++) *blocks[i] = shb_arena_take(&c->arena, all, one);
  c->work  = shb_arena_take(&c->arena, n * n + MHB_BLAS_ROOM, one);
  c->rows  = shb_arena_take(&c->arena, n * n + MHB_BLAS_ROOM, one);
  c->force = shb_arena_take(&c->arena, n, one);
  c->pivot = shb_arena_take(&c->arena, n, sizeof(int));
  return c;
}

void mhb_ring_condensation_destroy(mhb_ring_condensation *c) {
  if (!c) return;
  shb_arena_free(&c->arena);
  free(c);
}

/* ---- small matrices, row-major ---- */

static inline double complex times(double complex a, double complex b) {
  return CMPLX(creal(a) * creal(b) - cimag(a) * cimag(b),
               creal(a) * cimag(b) + cimag(a) * creal(b));
}

/* C[n][n] += sign A B */
static void add_product(int n, double sign, const double complex *A, const double complex *B,
                        double complex *C) {
  const double complex factor = sign, one = 1;
  if (n >= MHB_WORTH_BLAS) {
    cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, n, n, &factor, A, n, B, n, &one, C,
                n);
    return;
  }
  for (int i = 0; i < n; i++)
    for (int l = 0; l < n; l++) {
      const double complex a = sign * A[i * n + l];
      for (int j = 0; j < n; j++) C[i * n + j] += times(a, B[l * n + j]);
    }
}

/* y[n] += sign A x */
static void add_column(int n, double sign, const double complex *A, const double complex *x,
                       double complex *y) {
  for (int i = 0; i < n; i++, A += n) {
    double complex sum = 0;
    for (int j = 0; j < n; j++) sum += times(A[j], x[j]);
    y[i] += sign * sum;
  }
}

/* y[n] += sign x A */
static void add_row(int n, double sign, const double complex *x, const double complex *A,
                    double complex *y) {
  for (int i = 0; i < n; i++, A += n)
    for (int j = 0; j < n; j++) y[j] += sign * times(x[i], A[j]);
}

/* q[n] <- S x of a contact: its forces, and, S being symmetric, a row of x S. */
static void spring(const mhb_ring_condensation *c, int k, int contact, const double complex *x,
                   double complex *q) {
  const int P = c->n / 3;
  memset(q, 0, sizeof *q * (size_t)c->n);
  for (int j = 0; j < P; j++)
    if (c->kind[contact * P + j] == MHB_PAIR_STUCK)
      mhb_stick_force(&c->law[contact * P + j], k, x + 3 * j, q + 3 * j);
}

/* to[n][n] <- A S of a contact */
static void times_spring(const mhb_ring_condensation *c, int k, int contact,
                         const double complex *A, double complex *to) {
  for (int i = 0; i < c->n; i++) spring(c, k, contact, A + i * c->n, to + i * c->n);
}

/* ---- one contact leaves ---- */

bool mhb_ring_contact_is_linear(const mhb_pair_kind *kind, int pairs, int contact) {
  for (int j = 0; j < pairs; j++) {
    const mhb_pair_kind one = kind[contact * pairs + j];
    if (one != MHB_PAIR_STUCK && one != MHB_PAIR_OPEN) return false;
  }
  return true;
}

static bool moves(const mhb_ring_condensation *c, int contact) {
  const int P = c->n / 3;
  for (int j = 0; j < P; j++)
    if (c->kind[contact * P + j] == MHB_PAIR_STUCK) return true;
  return false;
}

static double complex *at(const mhb_ring_condensation *c, double complex *blocks, int k,
                          int contact) {
  return mhb_ring_condensation_at(c, blocks, k, contact);
}

static size_t bytes(const mhb_ring_condensation *c) {
  return sizeof(double complex) * (size_t)c->n * (size_t)c->n;
}

/* to += from, and from <- 0 */
static void merge(const mhb_ring_condensation *c, double complex *from, double complex *to) {
  for (int i = 0; i < c->n * c->n; i++) to[i] += from[i];
  memset(from, 0, bytes(c));
}

/* inverse <- (I + R S)^-1. Read by columns LAPACK sees the transpose, whose inverse it gives. */
static int invert(mhb_ring_condensation *c, int k, int i, double complex *inverse) {
  const int n = c->n;
  memset(inverse, 0, bytes(c));
  for (int j = 0; j < n; j++) inverse[j * (n + 1)] = 1;
  if (!moves(c, i)) return 1;
  times_spring(c, k, i, at(c, c->own, k, i), c->work);
  for (int j = 0; j < n; j++) c->work[j * (n + 1)] += 1;
  return mhb_factor_complex(n, c->work, c->pivot) &&
         mhb_solve_complex(n, c->work, c->pivot, n, inverse);
}

/* out[n][n] <- R S M^-1, R between a neighbour and contact i */
static void set_influence(mhb_ring_condensation *c, int k, int i, const double complex *R,
                          double complex *out) {
  memset(out, 0, bytes(c));
  times_spring(c, k, i, R, c->rows);
  add_product(c->n, 1, c->rows, at(c, c->inverse, k, i), out);
}

/* Harmonic k of contact i, whose neighbours are p and q. 0: singular. */
static int eliminate(mhb_ring_condensation *c, int k, int i) {
  const int       n = c->n, p = c->before[i], q = c->after[i];
  double complex *to_p = at(c, c->to_before, k, i), *to_q = at(c, c->to_after, k, i);
  double complex *own_p = at(c, c->own, k, p), *by_p = at(c, c->from_before, k, i);
  double complex *own_q = at(c, c->own, k, q), *by_q = at(c, c->from_after, k, i);
  if (p == i) { /* the last one: it meets itself round the ring */
    merge(c, to_p, own_p);
    merge(c, to_q, own_p);
  } else if (p == q) { /* both sides of the only other one */
    merge(c, to_q, to_p);
    merge(c, at(c, c->to_after, k, p), at(c, c->to_before, k, p));
  }
  if (!invert(c, k, i, at(c, c->inverse, k, i))) return 0;
  memset(by_q, 0, bytes(c));
  if (p == i) {
    memset(by_p, 0, bytes(c));
    return 1;
  }
  double complex *p_to_i = at(c, p == q ? c->to_before : c->to_after, k, p);
  double complex *q_to_i = at(c, c->to_before, k, q);
  if (!moves(c, i)) { /* without force it is felt by none */
    memset(by_p, 0, bytes(c));
    memset(p_to_i, 0, bytes(c));
    memset(q_to_i, 0, bytes(c));
    return 1;
  }
  set_influence(c, k, i, p_to_i, by_p);
  add_product(n, -1, by_p, to_p, own_p);
  memset(p_to_i, 0, bytes(c));
  if (p == q) return 1;
  set_influence(c, k, i, q_to_i, by_q);
  add_product(n, -1, by_q, to_q, own_q);
  add_product(n, -1, by_p, to_q, p_to_i); /* p and q are neighbours now */
  memset(q_to_i, 0, bytes(c));
  add_product(n, -1, by_q, to_p, q_to_i);
  return 1;
}

static void copy_blocks(mhb_ring_condensation *c, int k) {
  for (int b = 0; b < c->blades; b++) {
    memcpy(at(c, c->own, k, b), mhb_ring_receptance_block(c->ring, k, b, MHB_RING_OWN), bytes(c));
    memcpy(at(c, c->to_before, k, b), mhb_ring_receptance_block(c->ring, k, b, MHB_RING_BEFORE),
           bytes(c));
    memcpy(at(c, c->to_after, k, b), mhb_ring_receptance_block(c->ring, k, b, MHB_RING_AFTER),
           bytes(c));
  }
}

int mhb_ring_condensation_factor(mhb_ring_condensation *c, const mhb_law *law,
                                 const mhb_pair_kind *kind, int first) {
  const int N = c->blades;
  c->law      = law;
  c->kind     = kind;
  c->n_gone = c->n_left = 0;
  for (int b = 0; b < N; b++) {
    c->before[b]                                                             = (b + N - 1) % N;
    c->after[b]                                                              = (b + 1) % N;
    *(mhb_ring_contact_is_linear(kind, c->n / 3, b) ? &c->gone[c->n_gone++]
                                                    : &c->left[c->n_left++]) = b;
  }
  for (int k = first; k <= c->m; k++) copy_blocks(c, k);
  for (int g = 0; g < c->n_gone; g++) {
    const int i = c->gone[g];
    for (int k = first; k <= c->m; k++)
      if (!eliminate(c, k, i)) return 0;
    c->after[c->before[i]] = c->after[i];
    c->before[c->after[i]] = c->before[i];
  }
  return 1;
}

/* ---- solutions ---- */

void mhb_ring_condensation_forward(mhb_ring_condensation *c, int k, double complex *x) {
  const int n = c->n;
  for (int g = 0; g < c->n_gone; g++) {
    const int i = c->gone[g];
    if (!moves(c, i)) continue;
    add_column(n, -1, at(c, c->from_before, k, i), x + i * n, x + c->before[i] * n);
    add_column(n, -1, at(c, c->from_after, k, i), x + i * n, x + c->after[i] * n);
  }
}

void mhb_ring_condensation_backward(mhb_ring_condensation *c, int k, double complex *x,
                                    double complex *q) {
  const int n = c->n;
  for (int g = c->n_gone - 1; g >= 0; g--) {
    const int       i  = c->gone[g];
    double complex *to = x + i * n;
    if (c->before[i] != i) {
      add_column(n, -1, at(c, c->to_before, k, i), q + c->before[i] * n, to);
      add_column(n, -1, at(c, c->to_after, k, i), q + c->after[i] * n, to);
    }
    memcpy(c->force, to, sizeof *to * (size_t)n);
    memset(to, 0, sizeof *to * (size_t)n);
    add_column(n, 1, at(c, c->inverse, k, i), c->force, to);
    spring(c, k, i, to, q + i * n);
  }
}

void mhb_ring_condensation_functional(mhb_ring_condensation *c, int k, double complex *w,
                                      double complex *on_force) {
  const int n = c->n;
  memset(on_force, 0, sizeof *on_force * (size_t)(c->blades * n));
  for (int g = 0; g < c->n_gone; g++) {
    const int       i  = c->gone[g];
    double complex *to = w + i * n;
    spring(c, k, i, on_force + i * n, c->force); /* as one of x_i */
    for (int j = 0; j < n; j++) c->force[j] += to[j];
    memset(to, 0, sizeof *to * (size_t)n);
    add_row(n, 1, c->force, at(c, c->inverse, k, i), to);
    if (c->before[i] == i) continue;
    add_row(n, -1, to, at(c, c->to_before, k, i), on_force + c->before[i] * n);
    add_row(n, -1, to, at(c, c->to_after, k, i), on_force + c->after[i] * n);
  }
}

shb_status mhb_ring_linear_limit(const mhb_ring_receptance *ring, const mhb_law *law, int k,
                                 const mhb_pair_kind *kind, double complex *u) {
  mhb_ring_condensation *c = mhb_ring_condensation_create(ring, k);
  double complex        *q = shb_alloc_zeroed((size_t)ring->blades * (size_t)ring->n, sizeof *q);
  const int              regular = mhb_ring_condensation_factor(c, law, kind, k);
  if (regular) {
    mhb_ring_condensation_forward(c, k, u);
    mhb_ring_condensation_backward(c, k, u, q);
  }
  free(q);
  mhb_ring_condensation_destroy(c);
  SHB_CHECK(regular, SHB_ERR_INPUT, "the stuck system is singular at harmonic %d", k);
  return SHB_OK;
}
