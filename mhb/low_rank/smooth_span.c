#include "mhb/low_rank/smooth_span.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/numerics/random.h"

/* Singular values below it are left out, in the norm of the contact stiffness, where I is 1. */
static const double NEGLIGIBLE = 1e-12;

/* The same for a product of an iteration. */
static const double COARSE = 1e-6;

/* Columns of the first sketch, and of the largest one that may be the whole space. */
enum { FIRST_SKETCH = 128, MOST_WHOLE = 512 };

/* Factors of the axes in the norm of the contact stiffness, and what a sketch needs. */
typedef struct {
  const mhb_smooth_source *source;
  int                      n, n_sources;
  const double            *root; /* [n] of the stiffness */
  int                      columns;
  double                  *Q, *random, *image, *half; /* [n][columns] */
  double                  *small;                     /* [columns][sources * columns] */
  double                  *singular, *left, *work;
} sketch;

/* to += weight D^1/2 A D^1/2 from, D^1/2 = root, A that of the source. */
static void add_scaled(const sketch *s, int columns, int source, const double *from, double *to) {
  const int n = s->n;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < columns; j++) s->half[i * columns + j] = s->root[i] * from[i * columns + j];
  const mhb_smooth_source *of = &s->source[source];
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, columns, n, of->weight, of->A, n,
              s->half, columns, 0, s->image, columns);
  if (of->sign)
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, n, columns, n, of->sign * of->weight,
                of->A, n, s->half, columns, 1, s->image, columns);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < columns; j++) to[i * columns + j] += s->root[i] * s->image[i * columns + j];
}

static void sketch_free(sketch *s) {
  free(s->Q);
  free(s->random);
  free(s->image);
  free(s->half);
  free(s->small);
  free(s->singular);
  free(s->left);
  free(s->work);
}

static void sketch_allocate(sketch *s) {
  size_t q = (size_t)s->columns, rows = (size_t)s->n, sources = (size_t)s->n_sources;
  s->Q        = shb_alloc_zeroed(rows * q, sizeof(double));
  s->random   = shb_alloc_zeroed(rows * q, sizeof(double));
  s->image    = shb_alloc_zeroed(rows * q, sizeof(double));
  s->half     = shb_alloc_zeroed(rows * q, sizeof(double));
  s->small    = shb_alloc_zeroed(q * q * sources, sizeof(double));
  s->singular = shb_alloc_zeroed(q, sizeof(double));
  s->left     = shb_alloc_zeroed(q * q, sizeof(double));
  s->work     = shb_alloc_zeroed(q * q * sources, sizeof(double));
}

/* Q <- orthonormal basis of the image of all sources. */
static int find_range(sketch *s) {
  int                n = s->n, q = s->columns;
  unsigned long long seed = 1;
  for (int t = 0; t < s->n_sources; t++) {
    if (!s->source[t].A) continue;
    for (int i = 0; i < n * q; i++) s->random[i] = 0.5 * mhb_random(&seed);
    add_scaled(s, q, t, s->random, s->Q);
  }
  return LAPACKE_dgeqrf(LAPACK_ROW_MAJOR, n, q, s->Q, q, s->singular) == 0 &&
         LAPACKE_dorgqr(LAPACK_ROW_MAJOR, n, q, q, s->Q, q, s->singular) == 0;
}

/* Singular vectors of [Q^T A_t Q ...] by all sources: s->left, columns in falling order. */
static int reduce(sketch *s) {
  int n = s->n, q = s->columns, wide = s->n_sources * q;
  for (int t = 0; t < s->n_sources; t++) {
    memset(s->random, 0, sizeof(double) * (size_t)n * (size_t)q);
    if (s->source[t].A) add_scaled(s, q, t, s->Q, s->random);
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, q, q, n, 1, s->Q, q, s->random, q, 0,
                s->small + t * q, wide);
  }
  memcpy(s->work, s->small, sizeof(double) * (size_t)q * (size_t)wide);
  double rest[q];
  return LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'S', 'N', q, wide, s->work, wide, s->singular, s->left, q,
                        NULL, wide, rest) == 0;
}

/* x[n][columns] <- U U^+ x in the norm, U = Q left of this rank. */
static void project(const sketch *s, int rank, int columns, double *x, double *small,
                    double *back) {
  const int n = s->n, q = s->columns;
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, q, columns, n, 1, s->Q, q, x, columns, 0,
              small, columns);
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, rank, columns, q, 1, s->left, q, small,
              columns, 0, back, columns);
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, q, columns, rank, 1, s->left, q, back,
              columns, 0, small, columns);
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, columns, q, 1, s->Q, q, small, columns,
              0, x, columns);
}

/* Largest element of (A - U U^+ A U U^+) x over a few random x, in the norm: what U leaves out. */
static double left_out(sketch *s, int rank) {
  enum { PROBES = 4 };
  int                n = s->n, q = s->columns;
  unsigned long long seed = 77;
  double worst = 0, probe[PROBES * n], inside[PROBES * n], image[PROBES * n], small[PROBES * q],
         back[PROBES * q];
  for (int t = 0; t < s->n_sources; t++) {
    if (!s->source[t].A) continue;
    for (int i = 0; i < PROBES * n; i++) probe[i] = 0.5 * mhb_random(&seed);
    memset(image, 0, sizeof image);
    add_scaled(s, PROBES, t, probe, image);
    project(s, rank, PROBES, probe, small, back);
    memset(inside, 0, sizeof inside);
    add_scaled(s, PROBES, t, probe, inside);
    project(s, rank, PROBES, inside, small, back);
    for (int i = 0; i < PROBES * n; i++) worst = fmax(worst, fabs(image[i] - inside[i]));
  }
  return worst;
}

/* U = D^-1/2 Q left, and the sources between its columns. */
static void take(const sketch *s, int rank, shb_arena *arena, mhb_smooth_span *span) {
  int     n = s->n, q = s->columns, wide = s->n_sources * q;
  double *half = s->work;
  double *U    = shb_arena_take(arena, (size_t)n * (size_t)rank, sizeof(double));
  span->size   = shb_arena_take(arena, (size_t)rank, sizeof(double));
  span->C      = shb_arena_take(arena, (size_t)s->n_sources, sizeof *span->C);
  memcpy(span->size, s->singular, sizeof(double) * (size_t)rank);
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, rank, q, 1, s->Q, q, s->left, q, 0, U,
              rank);
  for (int i = 0; i < n; i++) cblas_dscal(rank, 1 / s->root[i], U + i * rank, 1);
  for (int t = 0; t < s->n_sources; t++) {
    if (!s->source[t].A) continue;
    double *to = shb_arena_take(arena, (size_t)rank * (size_t)rank, sizeof(double));
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, rank, q, q, 1 / s->source[t].weight,
                s->left, q, s->small + t * q, wide, 0, half, q);
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, rank, rank, q, 1, half, q, s->left, q, 0,
                to, rank);
    span->C[t] = to;
  }
  span->rank = rank;
  span->U    = U;
}

/* Few columns matter to a product of an iteration, or few are left at all. */
static int saves(const sketch *s, int rank) {
  return rank < s->n / 2 || s->singular[s->n / 2] < COARSE;
}

/* One sketch. 1: the space is found; 0: more columns are needed; -1: failed. */
static int try_sketch(sketch *s, shb_arena *arena, mhb_smooth_span *span) {
  sketch_allocate(s);
  if (!find_range(s) || !reduce(s)) return -1;
  int rank = 0;
  while (rank < s->columns && s->singular[rank] > NEGLIGIBLE) rank++;
  if (rank > s->columns - 16 && s->columns < s->n) return 0;
  if (left_out(s, rank) > 1e2 * NEGLIGIBLE || !saves(s, rank)) return -1;
  take(s, rank, arena, span);
  return 1;
}

void mhb_smooth_span_find(int n, const double *root, int n_sources, const mhb_smooth_source *source,
                          shb_arena *arena, mhb_smooth_span *span) {
  sketch s   = {.source = source, .n = n, .n_sources = n_sources, .root = root};
  int    any = 0, found = 0;
  *span = (mhb_smooth_span){0};
  for (int t = 0; t < n_sources; t++) any |= source[t].A != NULL;
  for (int q = FIRST_SKETCH; any && !found; q *= 2) {
    if (q >= n && n > MOST_WHOLE) break;
    s.columns = q < n ? q : n;
    found     = try_sketch(&s, arena, span);
    sketch_free(&s);
    if (s.columns == n) break;
  }
}
