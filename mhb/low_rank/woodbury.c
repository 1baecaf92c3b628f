#include "mhb/low_rank/woodbury.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/numerics/simd.h"

/* The basis holds for contact stiffnesses up to this factor from its own. */
static const double SAME_STIFFNESS = 2;

/* An axis without stiffness has this part of the largest. */
static const double LEAST_STIFFNESS = 1e-3;

/* What the products of an iteration may leave out, relative to the tolerance. */
static const double LEFT_OUT = 0.01;

/* Coefficients at most, and pairs of one product of matrices. */
enum { MOST_COEFFICIENTS = 240, PAIRS_AT_ONCE = 16 };

/* ---- life cycle ---- */

static void set_stiffness(const mhb_law *law, int n_pairs, double *stiffness) {
  double top = 0;
  for (int a = 0; a < n_pairs; a++)
    top = fmax(top, fmax(law[a].kv, fmax(law[a].ku[0], law[a].ku[2])));
  for (int a = 0; a < n_pairs; a++) {
    const double own[3] = {law[a].kv, law[a].ku[0], law[a].ku[2]};
    double       most   = fmax(own[0], fmax(own[1], own[2]));
    for (int c = 0; c < 3; c++)
      stiffness[3 * a + c] = fmax(own[c], LEAST_STIFFNESS * (most > 0 ? most : top));
  }
}

static int stiffness_holds(const mhb_woodbury *w, const mhb_law *law) {
  double now[w->n3];
  set_stiffness(law, w->n_pairs, now);
  for (int i = 0; i < w->n3; i++)
    if (now[i] > SAME_STIFFNESS * w->stiffness[i] || w->stiffness[i] > SAME_STIFFNESS * now[i])
      return 0;
  return 1;
}

/* Arrays for a basis of this size. */
static void make_room(mhb_woodbury *w, int size) {
  if (size <= w->room) return;
  size_t     r = (size_t)size;
  shb_arena *a = &w->of_basis;
  shb_arena_free(a);
  w->T     = shb_arena_take(a, r * r, sizeof(double));
  w->G     = shb_arena_take(a, r * r, sizeof(double));
  w->KX    = shb_arena_take(a, r, sizeof(double));
  w->pivot = shb_arena_take(a, r, sizeof(int));
  w->y     = shb_arena_take(a, r, sizeof(double));
  w->Ky    = shb_arena_take(a, r, sizeof(double));
  w->small = shb_arena_take(a, r, sizeof(double));
  w->rows  = shb_arena_take(a, (size_t)(PAIRS_AT_ONCE * 3 * w->nb) * r, sizeof(double));
  w->room  = size;
}

/* Another basis for the present stiffness. 0: there is no small one. */
static int renew(mhb_woodbury *w, const mhb_law *law) {
  mhb_contact_basis_destroy(w->basis);
  w->basis = NULL;
  set_stiffness(law, w->n_pairs, w->stiffness);
  int most   = w->n / 3 < MOST_COEFFICIENTS ? w->n / 3 : MOST_COEFFICIENTS;
  w->without = mhb_contact_basis_create(w->product, w->m, w->stiffness, w->low, w->high, most,
                                        &w->basis) != SHB_OK;
  if (!w->without) make_room(w, w->basis->size + 1);
  return !w->without;
}

mhb_woodbury *mhb_woodbury_create(mhb_receptance_product *product, const mhb_law *law, double low,
                                  double high) {
  mhb_woodbury *w = shb_alloc_zeroed(1, sizeof *w);
  w->product      = product;
  w->n3           = product->n;
  w->n_pairs      = product->n / 3;
  w->m            = product->m;
  w->nb           = product->nb;
  w->n            = w->n3 * w->nb;
  w->low          = low;
  w->high         = high;
  w->stiffness    = shb_arena_take(&w->arena, (size_t)w->n3, sizeof(double));
  w->force        = shb_arena_take(&w->arena, (size_t)w->n, sizeof(double));
  w->part         = shb_arena_take(&w->arena, 2 * (size_t)w->n3, sizeof(double));
  w->solution     = shb_arena_take(&w->arena, (size_t)w->n + 1, sizeof(double));
  size_t block = 3 * (size_t)w->nb, ld = (size_t)mhb_whole_lanes(3 * w->nb);
  w->turned    = shb_arena_take(&w->arena, block * ld, sizeof(double));
  w->image     = shb_arena_take(&w->arena, ld, sizeof(double));
  w->border[0] = shb_arena_take(&w->arena, (size_t)w->n + 1, sizeof(double));
  w->border[1] = shb_arena_take(&w->arena, (size_t)w->n + 1, sizeof(double));
  w->gmres     = mhb_gmres_create(w->n + 1, MHB_MOST_ITERATIONS);
  renew(w, law);
  return w;
}

void mhb_woodbury_destroy(mhb_woodbury *w) {
  if (!w) return;
  mhb_contact_basis_destroy(w->basis);
  mhb_gmres_destroy(w->gmres);
  shb_arena_free(&w->of_basis);
  shb_arena_free(&w->arena);
  free(w);
}

/* ---- parts ---- */

/* Place of harmonic k in a row of real form. */
static int place(int k) {
  return k ? 2 * k - 1 : 0;
}

/* to <- S x of a spring, both [3][nb]. */
static void spring_force(const mhb_law *law, int nb, const double *x, double *to) {
  const double *u = x + nb, *v = u + nb;
  for (int i = 0; i < nb; i++) {
    to[i]          = law->kv * x[i];
    to[nb + i]     = i ? law->ku[0] * u[i] + law->ku[1] * v[i] : 0;
    to[2 * nb + i] = i ? law->ku[1] * u[i] + law->ku[2] * v[i] : 0;
  }
}

/* w->force <- P x */
static void set_force(mhb_woodbury *w, const double *x) {
  int block = 3 * w->nb;
  for (int a = 0; a < w->n_pairs; a++, x += block) {
    double *to = w->force + a * block;
    if (w->form[a] == MHB_BLOCK_FULL)
      cblas_dgemv(CblasRowMajor, CblasNoTrans, block, block, 1,
                  w->full + (size_t)a * (size_t)block * (size_t)block, block, x, 1, 0, to, 1);
    else if (w->form[a] == MHB_BLOCK_SPRING)
      spring_force(&w->law[a], w->nb, x, to);
    else
      memset(to, 0, sizeof(double) * (size_t)block);
  }
}

/* y <- X^H x of all harmonics. */
static void gather(mhb_woodbury *w, const double *x, double *y) {
  const mhb_contact_basis *b = w->basis;
  for (int k = 0; k <= w->m; k++) {
    int parts = mhb_basis_parts(k), wide = parts * b->rank[k];
    if (wide == 0) continue;
    for (int i = 0; i < w->n3; i++)
      for (int p = 0; p < parts; p++) w->part[i * parts + p] = x[i * w->nb + place(k) + p];
    cblas_dgemv(CblasRowMajor, CblasTrans, parts * w->n3, wide, 1, b->X[k], wide, w->part, 1, 0,
                y + b->first[k], 1);
  }
}

/* x -= X y */
static void scatter(mhb_woodbury *w, const double *y, double *x) {
  const mhb_contact_basis *b = w->basis;
  for (int k = 0; k <= w->m; k++) {
    int parts = mhb_basis_parts(k), wide = parts * b->rank[k];
    if (wide == 0) continue;
    cblas_dgemv(CblasRowMajor, CblasNoTrans, parts * w->n3, wide, 1, b->X[k], wide, y + b->first[k],
                1, 0, w->part, 1);
    for (int i = 0; i < w->n3; i++)
      for (int p = 0; p < parts; p++) x[i * w->nb + place(k) + p] -= w->part[i * parts + p];
  }
}

/* to <- K y, or K^T y */
static void times_K(const mhb_woodbury *w, CBLAS_TRANSPOSE transpose, const double *y, double *to) {
  const mhb_contact_basis *b = w->basis;
  for (int k = 0; k <= w->m; k++) {
    int wide = mhb_basis_parts(k) * b->rank[k];
    if (wide > 0)
      cblas_dgemv(CblasRowMajor, transpose, wide, wide, 1, b->K[k], wide, y + b->first[k], 1, 0,
                  to + b->first[k], 1);
  }
}

/* ---- T ---- */

/* to[size][ld] <- from[size][size] transposed, ld >= size. */
MHB_HOT static void transpose(int size, const double *restrict from, int ld, double *restrict to) {
  for (int i = 0; i < size; i++)
    for (int j = 0; j < size; j++) to[j * ld + i] = from[i * size + j];
}

/* One column of P X of a pair: out[rows] <- P x, x[3 parts] in harmonic k alone. PT is P by
 * columns. */
MHB_HOT static void times_column(int rows, const double *PT, int nb, int k, const double *x,
                                 int next, double *restrict out) {
  const double *first = PT + (ptrdiff_t)place(k) * rows, *u = first + (ptrdiff_t)nb * rows,
               *v = u + (ptrdiff_t)nb * rows;
  if (k == 0) {
    for (int i = 0; i < rows; i++) out[i] = x[0] * first[i] + x[next] * u[i] + x[2 * next] * v[i];
    return;
  }
  for (int i = 0; i < rows; i++)
    out[i] = x[0] * first[i] + x[next] * first[rows + i] + x[2 * next] * u[i] +
             x[3 * next] * u[rows + i] + x[4 * next] * v[i] + x[5 * next] * v[rows + i];
}

/* Columns of P X of pair number j of a group of `count`, into w->rows: [k][size][pair axis part].
 */
static void add_image(mhb_woodbury *w, int pair, int j, int count) {
  const mhb_contact_basis *b     = w->basis;
  const int                block = 3 * w->nb, size = b->size, ld = mhb_whole_lanes(block);
  transpose(block, w->full + (size_t)pair * (size_t)block * (size_t)block, ld, w->turned);
  for (int k = 0; k <= b->m; k++) {
    const int     parts = mhb_basis_parts(k), wide = parts * b->rank[k];
    const double *X = b->X[k] + (size_t)(3 * pair * parts) * (size_t)wide;
    for (int i = 0; i < wide; i++) {
      times_column(ld, w->turned, w->nb, k, X + i, wide, w->image);
      for (int l = 0; l <= b->m; l++) {
        const int width = 3 * mhb_basis_parts(l);
        double   *to    = w->rows + (size_t)(3 * place(l) * count) * (size_t)size +
                     (size_t)((b->first[k] + i) * width * count + width * j);
        for (int c = 0; c < 3; c++)
          for (int p = 0; p < width / 3; p++)
            to[c * (width / 3) + p] = w->image[c * w->nb + place(l) + p];
      }
    }
  }
}

/* T += X^H P X of `count` pairs, by rows of harmonic. */
static void add_pairs(mhb_woodbury *w, const int *pair, int count) {
  const mhb_contact_basis *b    = w->basis;
  int                      size = b->size;
  double                   X[PAIRS_AT_ONCE * 6 * (size + 1)];
  for (int j = 0; j < count; j++) add_image(w, pair[j], j, count);
  for (int k = 0; k <= w->m; k++) {
    int parts = mhb_basis_parts(k), wide = parts * b->rank[k], rows = 3 * parts;
    if (wide == 0) continue;
    for (int j = 0; j < count; j++)
      memcpy(X + j * rows * wide, b->X[k] + (size_t)(pair[j] * rows) * (size_t)wide,
             sizeof(double) * (size_t)(rows * wide));
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasTrans, wide, size, rows * count, 1, X, wide,
                w->rows + (size_t)(3 * place(k) * count) * (size_t)size, rows * count, 1,
                w->T + (size_t)b->first[k] * (size_t)size, size);
  }
}

/* T += X^H S X of all springs: within a harmonic. */
static void add_springs(mhb_woodbury *w) {
  const mhb_contact_basis *b    = w->basis;
  int                      size = b->size;
  for (int a = 0; a < w->n_pairs; a++) {
    if (w->form[a] != MHB_BLOCK_SPRING) continue;
    const mhb_law *law        = &w->law[a];
    const double   S[2][3][3] = {
          {{law->kv}}, {{law->kv}, {0, law->ku[0], law->ku[1]}, {0, law->ku[1], law->ku[2]}}};
    for (int k = 0; k <= w->m; k++) {
      int           parts = mhb_basis_parts(k), wide = parts * b->rank[k];
      const double *X  = b->X[k] + (size_t)(3 * a * parts) * (size_t)wide;
      double       *to = w->T + (size_t)b->first[k] * (size_t)size + b->first[k];
      for (int i = 0; i < 9 * parts; i++) {
        int    c = i / (3 * parts), d = i / parts % 3, p = i % parts;
        double s = S[k > 0][c][d];
        if (s != 0)
          cblas_dger(CblasRowMajor, wide, wide, s, X + (c * parts + p) * wide, 1,
                     X + (d * parts + p) * wide, 1, to, size);
      }
    }
  }
}

static void set_T(mhb_woodbury *w) {
  int pair[PAIRS_AT_ONCE], count = 0;
  memset(w->T, 0, sizeof(double) * (size_t)w->basis->size * (size_t)w->basis->size);
  for (int a = 0; a < w->n_pairs; a++) {
    if (w->form[a] == MHB_BLOCK_FULL) pair[count++] = a;
    if (count == PAIRS_AT_ONCE || (count > 0 && a == w->n_pairs - 1)) {
      add_pairs(w, pair, count);
      count = 0;
    }
  }
  add_springs(w);
}

/* ---- the small system ---- */

/* G = I + T K, with borders. */
static void set_G(mhb_woodbury *w) {
  const mhb_contact_basis *b    = w->basis;
  int                      size = b->size, all = w->size, n = w->n;
  for (int k = 0; k <= w->m; k++) {
    int wide = mhb_basis_parts(k) * b->rank[k];
    if (wide > 0)
      cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, size, wide, wide, 1,
                  w->T + b->first[k], size, b->K[k], wide, 0, w->G + b->first[k], all);
  }
  for (int i = 0; i < size; i++) w->G[i * all + i] += 1;
  if (!w->column) return;
  set_force(w, w->column);
  gather(w, w->force, w->y);
  for (int i = 0; i < size; i++) w->G[i * all + size] = w->y[i];
  gather(w, w->row, w->y);
  times_K(w, CblasTrans, w->y, w->KX);
  for (int i = 0; i < size; i++) w->G[size * all + i] = -w->KX[i];
  w->G[size * all + size] = w->row[n] - cblas_ddot(n, w->row, 1, w->column, 1);
}

static int factor_small(mhb_woodbury *w) {
  int n   = w->size;
  w->sign = 1;
  if (n == 0) return 1;
  if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, w->G, n, w->pivot) != 0) return 0;
  for (int i = 0; i < n; i++) {
    if (w->G[i * n + i] < 0) w->sign = -w->sign;
    if (w->pivot[i] != i + 1) w->sign = -w->sign;
  }
  return 1;
}

int mhb_woodbury_prepare(mhb_woodbury *w, const mhb_law *law) {
  if (!stiffness_holds(w, law)) renew(w, law);
  if (w->without) return 0;
  mhb_receptance_product_update(w->product);
  mhb_contact_basis_update(w->basis);
  return 1;
}

int mhb_woodbury_factor(mhb_woodbury *w, const mhb_block *form, const double *full,
                        const mhb_law *law, const double *column, const double *row) {
  size_t bytes = sizeof(double) * ((size_t)w->n + 1);
  if (!mhb_woodbury_prepare(w, law)) return 0;
  w->form   = form;
  w->full   = full;
  w->law    = law;
  w->column = w->row = NULL;
  if (column) {
    memcpy(w->border[0], column, bytes);
    memcpy(w->border[1], row, bytes);
    w->column = w->border[0];
    w->row    = w->border[1];
  }
  w->gmres->iterations = 0;
  w->size              = w->basis->size + (column != NULL);
  set_T(w);
  set_G(w);
  return factor_small(w);
}

/* ---- solution ---- */

/* z <- M^-1 v */
static int precondition(mhb_woodbury *w, const double *v, double *z) {
  int size = w->basis->size, n = w->n;
  set_force(w, v);
  gather(w, w->force, w->small);
  if (w->column) w->small[size] = v[n] - cblas_ddot(n, w->row, 1, v, 1);
  if (w->size > 0 && LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', w->size, 1, w->G, w->size, w->pivot,
                                         w->small, w->size) != 0)
    return 0;
  times_K(w, CblasNoTrans, w->small, w->Ky);
  memcpy(z, v, sizeof(double) * (size_t)n);
  scatter(w, w->Ky, z);
  if (!w->column) return 1;
  z[n] = w->small[size];
  cblas_daxpy(n, -z[n], w->column, 1, z, 1);
  return 1;
}

/* z <- M^-1 v, Jz <- J z */
static int apply(void *context, const double *v, double *z, double *Jz) {
  mhb_woodbury *w = context;
  int           n = w->n;
  if (!precondition(w, v, z)) return 0;
  set_force(w, z);
  mhb_receptance_product_apply(w->product, MHB_PRODUCT_VALUE, w->negligible, w->force, Jz);
  cblas_daxpy(n, 1, z, 1, Jz, 1);
  if (!w->column) return 1;
  cblas_daxpy(n, z[n], w->column, 1, Jz, 1);
  Jz[n] = cblas_ddot(n, w->row, 1, z, 1) + w->row[n] * z[n];
  return 1;
}

int mhb_woodbury_solve(mhb_woodbury *w, double tolerance, double *rhs) {
  int size      = w->n + (w->column != NULL);
  w->negligible = LEFT_OUT * tolerance;
  int ok        = mhb_gmres_solve(w->gmres, size, apply, w, rhs, tolerance, w->solution);
  w->iterations = w->gmres->iterations;
  if (!ok) return 0;
  memcpy(rhs, w->solution, sizeof(double) * (size_t)size);
  return 1;
}

int mhb_woodbury_sign(const mhb_woodbury *w) {
  return mhb_gmres_negative(w->gmres) % 2 ? -w->sign : w->sign;
}
