#include "mhb/balance/stuck_solver.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/arena.h"
#include "mesh/base/memory.h"
#include "mhb/numerics/blas_room.h"

static const double SETTLED = 1e-14; /* residual, of the largest element of f */
enum { MOST_STEPS = 25 };

/* Of one harmonic. */
typedef struct {
  double complex *M;     /* [n][n] LU of I + T S; NULL: not made yet */
  double complex *W, *G; /* [n][modes] column-major, [modes][modes] row-major */
  int            *pivot; /* [n] */
  mhb_law        *law;   /* [pairs] of that factor */
  mhb_pair_kind  *kind;
  bool            known;
} factor;

struct mhb_stuck_solver {
  mhb_receptance_product *product;
  mhb_receptance         *receptance; /* of the product */
  int                     n, modes, top;
  factor                 *of;                    /* [top + 1] */
  double complex         *f, *p, *motion, *rest; /* [n] */
  double complex         *small, *force;         /* [modes][modes], [modes] */
  int                    *pivot;                 /* [modes] */
  shb_arena               arena;
};

mhb_stuck_solver *mhb_stuck_solver_create(mhb_receptance_product *product, int top) {
  mhb_stuck_solver *s = shb_alloc_zeroed(1, sizeof *s);
  mhb_receptance   *r = product->receptance;
  const size_t      n = (size_t)r->n, m = (size_t)r->n_modes, room = MHB_BLAS_ROOM;
  s->product    = product;
  s->receptance = r;
  s->n          = r->n;
  s->modes      = r->n_modes;
  s->top        = top;
  s->of         = shb_arena_take(&s->arena, (size_t)top + 1, sizeof *s->of);
  s->f          = shb_arena_take(&s->arena, n, sizeof *s->f);
  s->p          = shb_arena_take(&s->arena, n, sizeof *s->p);
  s->motion     = shb_arena_take(&s->arena, n, sizeof *s->motion);
  s->rest       = shb_arena_take(&s->arena, n, sizeof *s->rest);
  s->small      = shb_arena_take(&s->arena, m * m + room, sizeof *s->small);
  s->force      = shb_arena_take(&s->arena, m + 1, sizeof *s->force);
  s->pivot      = shb_arena_take(&s->arena, m + 1, sizeof *s->pivot);
  return s;
}

void mhb_stuck_solver_destroy(mhb_stuck_solver *s) {
  if (!s) return;
  shb_arena_free(&s->arena);
  free(s);
}

/* p = S x */
static void stick(const mhb_stuck_solver *s, int k, const mhb_law *law, const mhb_pair_kind *kind,
                  const double complex *x, double complex *p) {
  memset(p, 0, sizeof *p * (size_t)s->n);
  for (int a = 0; 3 * a < s->n; a++)
    if (kind[a] == MHB_PAIR_STUCK) mhb_stick_force(&law[a], k, x + 3 * a, p + 3 * a);
}

static bool same_law(const mhb_law *a, const mhb_law *b) {
  return a->kv == b->kv && a->ku[0] == b->ku[0] && a->ku[1] == b->ku[1] && a->ku[2] == b->ku[2];
}

static bool is_current(const mhb_stuck_solver *s, const factor *of, const mhb_law *law,
                       const mhb_pair_kind *kind) {
  for (int a = 0; 3 * a < s->n && of->known; a++)
    if (kind[a] != of->kind[a] || !same_law(&law[a], &of->law[a])) return false;
  return of->known;
}

static void take(mhb_stuck_solver *s, factor *of) {
  const size_t n = (size_t)s->n, m = (size_t)s->modes, pairs = n / 3;
  if (of->M) return;
  of->W     = shb_arena_take(&s->arena, n * m + MHB_BLAS_ROOM, sizeof *of->W);
  of->G     = shb_arena_take(&s->arena, m * m + 1, sizeof *of->G);
  of->pivot = shb_arena_take(&s->arena, n, sizeof *of->pivot);
  of->law   = shb_arena_take(&s->arena, pairs, sizeof *of->law);
  of->kind  = shb_arena_take(&s->arena, pairs, sizeof *of->kind);
  of->M     = shb_arena_take(&s->arena, n * n + MHB_BLAS_ROOM, sizeof *of->M);
}

/* LU of M, W and G. */
static bool make(mhb_stuck_solver *s, int k, double middle, const mhb_law *law,
                 const mhb_pair_kind *kind) {
  const mhb_receptance *r  = s->receptance;
  factor               *of = &s->of[k];
  const int             n = s->n, m = s->modes;
  const double complex *B = r->B + (size_t)k * (size_t)n * (size_t)m;
  double complex       *T = shb_alloc_zeroed((size_t)n * (size_t)n, sizeof *T);
  take(s, of);
  mhb_receptance_residual_terms(r, k, k * middle / r->nu, T);
  mhb_stick_matrix(n / 3, law, kind, k, T, of->M);
  free(T);
  memcpy(of->law, law, sizeof *law * (size_t)n / 3);
  memcpy(of->kind, kind, sizeof *kind * (size_t)n / 3);
  for (int j = 0; j < m; j++)
    for (int i = 0; i < n; i++) of->W[j * n + i] = B[i * m + j];
  of->known = LAPACKE_zgetrf_work(LAPACK_COL_MAJOR, n, n, of->M, n, of->pivot) == 0 &&
              LAPACKE_zgetrs_work(LAPACK_COL_MAJOR, 'N', n, m, of->M, n, of->pivot, of->W, n) == 0;
  for (int j = 0; j < m && of->known; j++) {
    stick(s, k, law, kind, of->W + j * n, s->p);
    for (int i = 0; i < m; i++) {
      double complex sum = 0;
      for (int row = 0; row < n; row++) sum += conj(B[row * m + i]) * s->p[row];
      of->G[i * m + j] = sum;
    }
  }
  return of->known;
}

/* LU of L^-1 + G, column-major. */
static bool set_modes(mhb_stuck_solver *s, int k) {
  const int             m = s->modes;
  const mhb_receptance *r = s->receptance;
  const double complex *L = r->lambda + (size_t)k * (size_t)m;
  if (r->factor) mhb_receptance_dynamic_stiffness(r, k, k * r->omega / r->nu, s->small);
  for (int i = 0; i < m; i++)
    for (int j = 0; j < m; j++) {
      const double complex inverse = r->factor ? s->small[j * m + i] : i == j ? 1 / L[i] : 0;
      s->small[j * m + i]          = s->of[k].G[i * m + j] + inverse;
    }
  return LAPACKE_zgetrf_work(LAPACK_COL_MAJOR, m, m, s->small, m, s->pivot) == 0;
}

/* x <- P^-1 x */
static bool precondition(mhb_stuck_solver *s, int k, const mhb_law *law, const mhb_pair_kind *kind,
                         double complex *x) {
  const factor         *of = &s->of[k];
  const int             n = s->n, m = s->modes;
  const double complex *B = s->receptance->B + (size_t)k * (size_t)n * (size_t)m;
  if (LAPACKE_zgetrs_work(LAPACK_COL_MAJOR, 'N', n, 1, of->M, n, of->pivot, x, n) != 0)
    return false;
  stick(s, k, law, kind, x, s->p);
  memset(s->force, 0, sizeof *s->force * (size_t)m);
  for (int row = 0; row < n; row++)
    for (int i = 0; i < m; i++) s->force[i] += conj(B[row * m + i]) * s->p[row];
  if (LAPACKE_zgetrs_work(LAPACK_COL_MAJOR, 'N', m, 1, s->small, m, s->pivot, s->force, m) != 0)
    return false;
  for (int j = 0; j < m; j++)
    for (int i = 0; i < n; i++) x[i] -= of->W[j * n + i] * s->force[j];
  return true;
}

static double largest(int n, const double complex *x) {
  double most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(creal(x[i])) + fabs(cimag(x[i])));
  return most;
}

/* rest <- f - (I + R S) u */
static void set_rest(mhb_stuck_solver *s, int k, const mhb_law *law, const mhb_pair_kind *kind,
                     const double complex *u) {
  stick(s, k, law, kind, u, s->p);
  mhb_receptance_product_of_harmonic(s->product, k, s->p, s->motion);
  for (int i = 0; i < s->n; i++) s->rest[i] = s->f[i] - u[i] - s->motion[i];
}

bool mhb_stuck_solver_solve(mhb_stuck_solver *s, int k, double middle, const mhb_law *law,
                            const mhb_pair_kind *kind, double complex *u) {
  const double size = largest(s->n, u);
  if (!is_current(s, &s->of[k], law, kind) && !make(s, k, middle, law, kind)) return false;
  mhb_receptance_product_update(s->product);
  if (!set_modes(s, k)) return false;
  memcpy(s->f, u, sizeof *u * (size_t)s->n);
  memcpy(s->rest, u, sizeof *u * (size_t)s->n);
  memset(u, 0, sizeof *u * (size_t)s->n);
  double before = INFINITY;
  for (int step = 0; step < MOST_STEPS && precondition(s, k, law, kind, s->rest); step++) {
    for (int i = 0; i < s->n; i++) u[i] += s->rest[i];
    set_rest(s, k, law, kind, u);
    const double left  = largest(s->n, s->rest);
    const double scale = fmax(size, largest(s->n, u));
    if (left <= SETTLED * scale || (left <= 100 * SETTLED * scale && left > 0.3 * before))
      return true; /* the second: rounding */
    if (!(left < 0.9 * before)) break;
    before = left;
  }
  memcpy(u, s->f, sizeof *u * (size_t)s->n);
  return false;
}
