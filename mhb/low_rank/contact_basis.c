#include "mhb/low_rank/contact_basis.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/numerics/blas_room.h"
#include "mhb/numerics/random.h"

static const double FIRST_BOUND = 0.05, LAST_BOUND = 0.8;

/* Candidates that depend on the others to this part are dropped. */
static const double DEPENDENT = 1e-9;

enum { FREQUENCIES = 5, FIRST_BLOCK = 16, POWERS = 4 };

static const double complex ONE = 1, ZERO = 0;

/* ---- leading eigenvectors of the residual flexibility ---- */

/* Eigenvectors of D^1/2 F D^1/2 above a bound. */
typedef struct {
  int     n, count, block;
  double *root;   /* [n] D^1/2 */
  double *vector; /* [n][block] */
  double *value;  /* [block] falling */
} leading;

/* image <- D^1/2 F D^1/2 vector */
static void apply_flexibility(const leading *e, const double *F, const double *from, double *half,
                              double *image) {
  int q = e->block;
  for (int i = 0; i < e->n; i++)
    for (int j = 0; j < q; j++) half[i * q + j] = e->root[i] * from[i * q + j];
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, e->n, q, e->n, 1, F, e->n, half, q, 0,
              image, q);
  for (int i = 0; i < e->n; i++) cblas_dscal(q, e->root[i], image + i * q, 1);
}

/* Subspace iteration with one block. 0: failed. */
static int iterate(leading *e, const double *F, double *half, double *image, double *small) {
  int                n = e->n, q = e->block;
  unsigned long long seed = 3;
  for (int i = 0; i < n * q; i++) e->vector[i] = 0.5 * mhb_random(&seed);
  for (int power = 0; power < POWERS; power++) {
    if (power > 0) memcpy(e->vector, image, sizeof(double) * (size_t)n * (size_t)q);
    if (LAPACKE_dgeqrf(LAPACK_ROW_MAJOR, n, q, e->vector, q, e->value) != 0 ||
        LAPACKE_dorgqr(LAPACK_ROW_MAJOR, n, q, q, e->vector, q, e->value) != 0)
      return 0;
    apply_flexibility(e, F, e->vector, half, image);
  }
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, q, q, n, 1, e->vector, q, image, q, 0, small,
              q);
  if (LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'V', 'U', q, small, q, e->value) != 0) return 0;
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, q, q, 1, e->vector, q, small, q, 0,
              half, q);
  for (int j = 0; j < q; j++) /* falling order */
    for (int i = 0; i < n; i++) e->vector[i * q + j] = half[i * q + q - 1 - j];
  for (int j = 0; j < q / 2; j++) {
    double t            = e->value[j];
    e->value[j]         = e->value[q - 1 - j];
    e->value[q - 1 - j] = t;
  }
  return 1;
}

static void leading_free(leading *e) {
  free(e->root);
  free(e->vector);
  free(e->value);
}

static int find_block(leading *e, const double *F, double bound) {
  size_t n = (size_t)e->n, q = (size_t)e->block;
  free(e->vector);
  free(e->value);
  e->vector     = shb_alloc_zeroed(n * q, sizeof(double));
  e->value      = shb_alloc_zeroed(q, sizeof(double));
  double *half  = shb_alloc_zeroed(n * q, sizeof(double));
  double *image = shb_alloc_zeroed(n * q, sizeof(double));
  double *small = shb_alloc_zeroed(q * q, sizeof(double));
  int     ok    = iterate(e, F, half, image, small);
  free(half);
  free(image);
  free(small);
  for (e->count = 0; ok && e->count < e->block && e->value[e->count] > bound;) e->count++;
  return ok;
}

static int find_leading(leading *e, const double *F, double bound, int most) {
  e->count = e->block = 0;
  if (!F) return 1;
  for (int q = FIRST_BLOCK; q <= e->n; q *= 2) {
    e->block = q;
    if (!find_block(e, F, bound)) return 0;
    if (e->count <= q - 4) return 1;
    if (q > most) return 0;
  }
  return e->count < e->n / 2; /* too small a face to have a smooth part */
}

/* ---- X of a harmonic ---- */

typedef struct {
  int             columns, kept; /* candidates; independent ones */
  double complex *C;      /* [n][columns] D^1/2 [B S E], then an orthonormal basis [n][kept] */
  double complex *square; /* [columns][columns] */
  double complex *G;      /* [columns][poles] Q^H D^1/2 [B S] */
  double complex *H;      /* [2 blocks][columns][columns], kept of both */
  double complex *left;   /* [columns][columns] */
  double         *value;  /* [columns] */
  double complex *work;   /* [columns][poles] */
} candidates;

static int n_poles(const mhb_receptance *r) {
  return r->n_modes + r->residual_terms->r;
}

/* Row of [B_k S_k]. */
static double complex shape(const mhb_receptance *r, int k, int row, int i) {
  int m = r->n_modes, rest = r->residual_terms->r;
  return i < m ? r->B[((size_t)k * (size_t)r->n + (size_t)row) * (size_t)m + (size_t)i]
               : r->residual_terms
                     ->S[((size_t)k * (size_t)r->n + (size_t)row) * (size_t)rest + (size_t)(i - m)];
}

/* C <- orthonormal basis of the candidates, by their Gram matrix. */
static int orthonormalise(candidates *c, int n) {
  int q = c->columns;
  for (int j = 0; j < q; j++) {
    double length = cblas_dznrm2(n, c->C + j, q);
    if (length > 0) cblas_zdscal(n, 1 / length, c->C + j, q);
  }
  cblas_zgemm(CblasRowMajor, CblasConjTrans, CblasNoTrans, q, q, n, &ONE, c->C, q, c->C, q, &ZERO,
              c->square, q);
  if (LAPACKE_zheev(LAPACK_COL_MAJOR, 'V', 'L', q, c->square, q, c->value) != 0) return 0;
  int dropped = 0;
  while (dropped < q && c->value[dropped] < DEPENDENT * c->value[q - 1]) dropped++;
  c->kept = q - dropped;
  for (int i = 0; i < q; i++)
    for (int j = 0; j < c->kept; j++)
      c->left[i * c->kept + j] =
          conj(c->square[(dropped + j) * q + i]) / sqrt(c->value[dropped + j]);
  double complex *row = c->work;
  for (int i = 0; i < n; i++) {
    cblas_zgemv(CblasRowMajor, CblasTrans, q, c->kept, &ONE, c->left, c->kept, c->C + i * q, 1,
                &ZERO, row, 1);
    memcpy(c->C + i * c->kept, row, sizeof *row * (size_t)c->kept); /* kept <= q: rows move up */
  }
  return 1;
}

/* 1/(w_i^2 - w^2 + 2 j zeta w_i w), not nearer to an undamped resonance than 1e-4 of it. */
static double complex receptance_of(const modal_model *model, int i, double held, double w) {
  double wi   = fmax(SHB_TWO_PI * model->frequency[i], held),
         zeta = fmax(model->damping_ratio[i], 5e-5);
  return 1.0 / CMPLX(wi * wi - w * w, 2 * zeta * wi * w);
}

/* Block of H: Q^H D^1/2 R_k D^1/2 Q at w, and its conjugate transpose below it. */
static void add_frequency(const mhb_receptance *r, int k, candidates *c, const leading *e,
                          const double complex *QE, double w, int block) {
  int                q = c->kept, poles = n_poles(r);
  const modal_model *model  = mhb_receptance_model(r, k);
  modal_series       series = modal_series_at(model, w);
  double complex    *at = c->H + 2 * block * q * q, *below = at + q * q;
  double             slope;
  for (int j = 0; j < poles; j++) {
    double complex L = 0; /* beyond the residual modes of the harmonic */
    if (j < r->n_modes)
      L = receptance_of(model, j, k == 0 ? r->hold : 0, w);
    else if (j - r->n_modes < model->n_residual)
      L = modal_series_mode(model, j - r->n_modes, &series, &slope);
    for (int i = 0; i < q; i++) c->work[i * poles + j] = L * c->G[i * poles + j];
  }
  cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasConjTrans, q, q, poles, &ONE, c->work, poles, c->G,
              poles, &ZERO, at, q);
  for (int i = 0; i < q; i++)
    for (int j = 0; j < q; j++)
      for (int l = 0; l < e->count; l++)
        at[i * q + j] += e->value[l] * QE[i * e->count + l] * conj(QE[j * e->count + l]);
  for (int i = 0; i < q; i++)
    for (int j = 0; j < q; j++) below[i * q + j] = conj(at[j * q + i]);
}

/* Frequencies of harmonic k, w rad/s: across the range, and the resonances that it passes. */
static int list_frequencies(const mhb_receptance *r, int k, double low, double high, double *w) {
  int    count = 0;
  double from = k * low / r->nu, to = k * high / r->nu;
  for (int i = 0; i < FREQUENCIES; i++) w[count++] = from + (to - from) * i / (FREQUENCIES - 1);
  for (int i = 0; i < r->n_modes; i++) {
    double wi = SHB_TWO_PI * mhb_receptance_model(r, k)->frequency[i];
    if (wi > from && wi < to) w[count++] = wi;
  }
  return count;
}

static void candidates_free(candidates *c) {
  free(c->C);
  free(c->square);
  free(c->G);
  free(c->H);
  free(c->left);
  free(c->value);
  free(c->work);
}

static void candidates_allocate(candidates *c, const mhb_receptance *r, int blocks) {
  size_t q = (size_t)c->columns, poles = (size_t)n_poles(r) + q;
  c->C      = shb_alloc_zeroed((size_t)r->n * q + MHB_BLAS_ROOM, sizeof *c->C);
  c->square = shb_alloc_zeroed(q * q + MHB_BLAS_ROOM, sizeof *c->square);
  c->G      = shb_alloc_zeroed(q * poles, sizeof *c->G);
  c->H      = shb_alloc_zeroed(q * q * 2 * (size_t)blocks + MHB_BLAS_ROOM, sizeof *c->H);
  c->left   = shb_alloc_zeroed(q * q, sizeof *c->left);
  c->value  = shb_alloc_zeroed(q, sizeof *c->value);
  c->work   = shb_alloc_zeroed(q * poles, sizeof *c->work);
}

/* C and G and H of a harmonic; right singular vectors of H to `left`, values to `value`. */
static int decompose(mhb_contact_basis *b, int k, const leading *e, const double *w, int count,
                     candidates *c) {
  const mhb_receptance *r = b->receptance;
  int                   n = b->n, q = c->columns, poles = n_poles(r);
  double complex       *QE = shb_alloc_zeroed((size_t)q * (size_t)(e->count + 1), sizeof *QE);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < q; j++)
      c->C[i * q + j] =
          j < poles ? e->root[i] * shape(r, k, i, j) : e->vector[i * e->block + j - poles];
  int ok = orthonormalise(c, n);
  q      = c->kept;
  for (int i = 0; i < n && ok; i++)
    for (int a = 0; a < q; a++) {
      double complex x = conj(c->C[i * q + a]);
      for (int j = 0; j < poles; j++) c->G[a * poles + j] += x * e->root[i] * shape(r, k, i, j);
      for (int l = 0; l < e->count; l++) QE[a * e->count + l] += x * e->vector[i * e->block + l];
    }
  for (int i = 0; i < count && ok; i++) add_frequency(r, k, c, e, QE, w[i], i);
  free(QE);
  double rest[q + 1];
  ok = ok && LAPACKE_zgesvd(LAPACK_COL_MAJOR, 'S', 'N', q, 2 * count * q, c->H, q, c->value,
                            c->square, q, NULL, 1, rest) == 0;
  for (int i = 0; i < q && ok; i++)
    for (int j = 0; j < q; j++) c->left[i * q + j] = conj(c->square[j * q + i]);
  return ok;
}

/* Real form of the columns D^-1/2 Q left. */
static void take_columns(mhb_contact_basis *b, int k, const leading *e, const candidates *c) {
  int n = b->n, q = c->kept, rank = b->rank[k], parts = mhb_basis_parts(k), wide = parts * rank;
  b->X[k] = shb_arena_take(&b->arena, (size_t)n * (size_t)(parts * wide), sizeof(double));
  for (int i = 0; i < n; i++)
    for (int j = 0; j < rank; j++) {
      double complex x = 0;
      for (int l = 0; l < q; l++) x += c->C[i * q + l] * c->left[l * q + j];
      x /= e->root[i];
      double *to = b->X[k] + (size_t)i * (size_t)(parts * wide);
      to[j]      = creal(x);
      if (k == 0) continue;
      to[rank + j]        = -cimag(x);
      to[wide + j]        = cimag(x);
      to[wide + rank + j] = creal(x);
    }
}

static int make_harmonic(mhb_contact_basis *b, int k, const leading *e, double low, double high) {
  const mhb_receptance *r = b->receptance;
  double                w[FREQUENCIES + r->n_modes];
  candidates            c     = {.columns = n_poles(r) + e->count};
  int                   count = list_frequencies(r, k, low, high, w);
  if (c.columns == 0) return 0;
  candidates_allocate(&c, r, count);
  const int ok = decompose(b, k, e, w, count, &c);
  while (ok && b->rank[k] < c.kept && c.value[b->rank[k]] > b->bound) b->rank[k]++;
  if (ok) take_columns(b, k, e, &c);
  candidates_free(&c);
  return ok;
}

/* ---- projections ---- */

/* D X, complex [n][rank] as two real ones. */
static void set_weighted(const mhb_contact_basis *b, int k, double *re, double *im) {
  int rank = b->rank[k], parts = mhb_basis_parts(k), wide = parts * rank;
  for (int i = 0; i < b->n; i++)
    for (int j = 0; j < rank; j++) {
      const double *from = b->X[k] + (size_t)i * (size_t)(parts * wide);
      re[i * rank + j]   = b->stiffness[i] * from[j];
      im[i * rank + j]   = k ? b->stiffness[i] * from[wide + j] : 0;
    }
}

/* A real matrix of the residual terms: A, or A + sign A^T. */
typedef struct {
  const double *A; /* [n][n], NULL: none */
  int           sign;
} projected_matrix;

/* image[n][rank] <- matrix from */
static void times(int n, int rank, projected_matrix of, const double *from, double *image) {
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, rank, n, 1, of.A, n, from, rank, 0,
              image, rank);
  if (of.sign)
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, n, rank, n, of.sign, of.A, n, from, rank,
                1, image, rank);
}

/* out[rank][rank] <- X^H D A D X for a real matrix; image [n][2 rank]. */
static void project(const mhb_contact_basis *b, int rank, projected_matrix of, const double *re,
                    const double *im, double *image, double complex *out) {
  int     n   = b->n;
  double *Are = image, *Aim = image + n * rank, part[4][rank * rank + 1];
  times(n, rank, of, re, Are);
  times(n, rank, of, im, Aim);
  const double *left[4] = {re, im, re, im}, *right[4] = {Are, Aim, Aim, Are};
  for (int i = 0; i < 4; i++)
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, rank, rank, n, 1, left[i], rank, right[i],
                rank, 0, part[i], rank);
  for (int i = 0; i < rank * rank; i++)
    out[i] = CMPLX(part[0][i] + part[1][i], part[2][i] - part[3][i]);
}

/* out[rank][rank] <- X^H D A D X for a complex A; the columns of D X as two real ones. */
static void project_wave(const mhb_contact_basis *b, int rank, const double complex *A,
                         const double *re, const double *im, double complex *out) {
  const int       n     = b->n;
  const size_t    all   = (size_t)n * (size_t)rank;
  double complex *room  = shb_alloc_zeroed(2 * all + MHB_BLAS_ROOM, sizeof *room),
                 *image = room + all;
  for (size_t i = 0; i < all; i++) room[i] = CMPLX(re[i], im[i]);
  cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, rank, n, &ONE, A, n, room, rank, &ZERO,
              image, rank);
  cblas_zgemm(CblasRowMajor, CblasConjTrans, CblasNoTrans, rank, rank, n, &ONE, room, rank, image,
              rank, &ZERO, out, rank);
  free(room);
}

/* self, C + C^T and C - C^T of each residual term. */
static projected_matrix matrix_of(const mhb_receptance *r, int i) {
  const mhb_cyclic_flexibility *f = r->residual_terms->contact[i / 3];
  if (!f) return (projected_matrix){NULL, 0};
  return i % 3 ? (projected_matrix){f->coupling, i % 3 == 1 ? 1 : -1}
               : (projected_matrix){f->self, 0};
}

static void make_projections(mhb_contact_basis *b, int k) {
  const mhb_receptance *r = b->receptance;
  int                   n = b->n, rank = b->rank[k], poles = n_poles(r), parts = mhb_basis_parts(k);
  size_t                square = (size_t)rank * (size_t)rank, all = (size_t)n * (size_t)rank;
  double               *room = shb_alloc_zeroed(4 * all + 1, sizeof(double));
  b->projected[k] = shb_arena_take(&b->arena, MHB_PROJECTIONS * square, sizeof(double complex));
  b->pole[k]      = shb_arena_take(&b->arena, (size_t)rank * (size_t)poles, sizeof(double complex));
  b->K[k]         = shb_arena_take(&b->arena, square * (size_t)(parts * parts), sizeof(double));
  double *re = room, *im = re + all, *image = im + all;
  set_weighted(b, k, re, im);
  for (int i = 0; i < MHB_PROJECTIONS && rank > 0; i++)
    if (matrix_of(r, i).A)
      project(b, rank, matrix_of(r, i), re, im, image, b->projected[k] + (size_t)i * square);
  for (int t = 0; t < MODAL_TERMS && rank > 0; t++)
    if (r->residual_terms->own[t])
      project_wave(b, rank, r->residual_terms->own[t] + (size_t)k * (size_t)n * (size_t)n, re, im,
                   b->projected[k] + (size_t)(3 * t) * square);
  for (int i = 0; i < n; i++)
    for (int a = 0; a < rank; a++) {
      double complex x = CMPLX(re[i * rank + a], -im[i * rank + a]);
      for (int j = 0; j < poles; j++) b->pole[k][a * poles + j] += x * shape(r, k, i, j);
    }
  free(room);
}

/* ---- life cycle ---- */

static int make_all(mhb_contact_basis *b, leading *e, const double *own, double low, double high,
                    int most) {
  for (b->bound = FIRST_BOUND;; b->bound *= 2) {
    int ok  = find_leading(e, own, b->bound, most);
    b->size = 0;
    for (int k = 0; k <= b->m && ok; k++) {
      b->rank[k]  = 0;
      ok          = make_harmonic(b, k, e, low, high);
      b->first[k] = b->size;
      b->size += mhb_basis_parts(k) * b->rank[k];
    }
    if (ok && b->size <= most) break;
    if (2 * b->bound > LAST_BOUND) return 0;
  }
  for (int k = 0; k <= b->m; k++) make_projections(b, k);
  return 1;
}

shb_status mhb_contact_basis_create(const mhb_receptance_product *product, int m,
                                    const double *stiffness, double low, double high, int most,
                                    mhb_contact_basis **out) {
  const mhb_receptance *r = product->receptance;
  mhb_contact_basis    *b = shb_alloc_zeroed(1, sizeof *b);
  leading               e = {.n = r->n, .root = shb_alloc_zeroed((size_t)r->n, sizeof(double))};
  size_t                K = (size_t)m + 1;
  *b                      = (mhb_contact_basis){.receptance = r, .n = r->n, .m = m, .omega = NAN};
  b->rank                 = shb_arena_take(&b->arena, K, sizeof *b->rank);
  b->first                = shb_arena_take(&b->arena, K, sizeof *b->first);
  b->X                    = shb_arena_take(&b->arena, K, sizeof *b->X);
  b->K                    = shb_arena_take(&b->arena, K, sizeof *b->K);
  b->projected            = shb_arena_take(&b->arena, K, sizeof *b->projected);
  b->pole                 = shb_arena_take(&b->arena, K, sizeof *b->pole);
  b->stiffness            = shb_arena_take(&b->arena, (size_t)r->n, sizeof(double));
  memcpy(b->stiffness, stiffness, sizeof(double) * (size_t)r->n);
  for (int i = 0; i < r->n; i++) e.root[i] = sqrt(stiffness[i]);
  const int ok = make_all(b, &e, product->own[0], low, high, most);
  leading_free(&e);
  if (!ok) {
    mhb_contact_basis_destroy(b);
    SHB_FAIL(SHB_NOT_CONVERGED, "no small basis of %d contact pairs", r->n / 3);
  }
  *out = b;
  return SHB_OK;
}

void mhb_contact_basis_destroy(mhb_contact_basis *b) {
  if (!b) return;
  shb_arena_free(&b->arena);
  free(b);
}

/* ---- at a frequency ---- */

static double complex entry(const mhb_contact_basis *b, int k, const modal_series *series,
                            size_t at) {
  const mhb_receptance *r      = b->receptance;
  size_t                square = (size_t)b->rank[k] * (size_t)b->rank[k];
  double complex        sum    = 0;
  for (int t = 0; t < MODAL_TERMS; t++) {
    const double complex *p = b->projected[k] + (size_t)(3 * t) * square + at;
    sum += series->weight[t] * /* a disc has the first alone */
           (p[0] - creal(r->phase[k]) * p[square] - I * cimag(r->phase[k]) * p[2 * square]);
  }
  return sum;
}

/* y[poles] <- L X^H D [B S] of column j, conjugate: [B S] L [B S]^H D X. */
static void set_response(const mhb_contact_basis *b, int k, int j, const double *g,
                         double complex *y) {
  const mhb_receptance *r     = b->receptance;
  const int             modes = r->n_modes, poles = n_poles(r);
  for (int l = 0; l < poles; l++) y[l] = conj(b->pole[k][j * poles + l]);
  if (r->factor) mhb_receptance_coupled(r, k, y);
  for (int l = r->factor ? modes : 0; l < poles; l++)
    y[l] *= l < modes ? r->lambda[k * modes + l] : g[l - modes];
}

static void update_harmonic(mhb_contact_basis *b, int k) {
  const mhb_receptance *r     = b->receptance;
  const modal_model    *model = mhb_receptance_model(r, k);
  const int             rank = b->rank[k], poles = n_poles(r), rest = r->residual_terms->r;
  modal_series          series = modal_series_at(model, k * r->omega / r->nu);
  double                slope, g[rest + 1];
  double complex        y[poles + 1];
  for (int i = 0; i < rest; i++)
    g[i] = i < model->n_residual ? modal_series_mode(model, i, &series, &slope) : 0;
  for (int j = 0; j < rank; j++) {
    set_response(b, k, j, g, y);
    for (int i = 0; i < rank; i++) {
      double complex sum = entry(b, k, &series, (size_t)i * (size_t)rank + (size_t)j);
      for (int l = 0; l < poles; l++) sum += b->pole[k][i * poles + l] * y[l];
      double *to = b->K[k] + i * rank * mhb_basis_parts(k) + j;
      to[0]      = creal(sum);
      if (k == 0) continue;
      to[rank]                   = -cimag(sum);
      to[2 * rank * rank]        = cimag(sum);
      to[2 * rank * rank + rank] = creal(sum);
    }
  }
}

void mhb_contact_basis_update(mhb_contact_basis *b) {
  if (b->omega == b->receptance->omega) return;
  b->omega = b->receptance->omega;
  for (int k = 0; k <= b->m; k++) update_harmonic(b, k);
}
