#include "mhb/balance/condensation.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/balance/stick_stiffness.h"
#include "mhb/numerics/lu.h"

/* Below this many stuck unknowns the harmonics are not shared out to threads. */
enum { WORTH_THREADS = 72 };

static const double complex ONE = 1, MINUS = -1;

static size_t rows_of(const mhb_condensation *s) {
  return 3 * (size_t)s->b->n_pairs;
}

/* Everything a thread may need, from one block: touched only as far as it is used. */
static int allocate(mhb_condensation *s) {
  size_t pairs = (size_t)s->b->n_pairs, n3 = rows_of(s), K = (size_t)s->b->m + 1,
         one     = (size_t)s->most + MHB_MOST_BORDERS,
         borders = 1 + 2 * (pairs < MHB_MOST_AT_LIMIT ? pairs : MHB_MOST_AT_LIMIT);
  s->kind        = calloc(pairs, sizeof *s->kind);
  s->have        = calloc(K, 1);
  s->moving      = calloc(pairs, sizeof(int));
  s->stuck       = calloc(pairs, sizeof(int));
  s->factored    = calloc(pairs, sizeof(int));
  s->pivot       = calloc(one, sizeof(int));
  s->A_pivot     = calloc(K * n3, sizeof(int));
  s->dense       = malloc(one * one * sizeof(double));
  s->y           = calloc(one, sizeof(double));
  s->A           = malloc(K * n3 * n3 * sizeof(double complex));
  s->reach       = malloc(K * n3 * n3 * sizeof(double complex));
  s->mixed       = malloc(K * n3 * n3 * sizeof(double complex));
  s->f           = calloc(K * n3, sizeof(double complex));
  s->c           = calloc(borders * K * n3, sizeof(double complex));
  s->t           = calloc(borders * K * n3, sizeof(double complex));
  s->q           = calloc(K * n3, sizeof(double complex));
  s->s           = calloc(K * n3, sizeof(double complex));
  return s->kind && s->have && s->moving && s->stuck && s->factored && s->pivot && s->A_pivot &&
         s->dense && s->y && s->A && s->reach && s->mixed && s->f && s->c && s->t && s->q && s->s;
}

shb_status mhb_condensation_create(const mhb_balance *residual, mhb_condensation **out) {
  return mhb_condensation_create_within(residual, residual->n, out);
}

shb_status mhb_condensation_create_within(const mhb_balance *residual, int most,
                                          mhb_condensation **out) {
  mhb_condensation *s = calloc(1, sizeof *s);
  SHB_CHECK(s, SHB_ERR_IO, "out of memory");
  s->b       = residual;
  s->m       = residual->m;
  s->n_pairs = residual->n_pairs;
  s->most    = most < residual->n ? most : residual->n;
  s->omega   = NAN;
  if (!allocate(s)) {
    mhb_condensation_destroy(s);
    SHB_FAIL(SHB_ERR_IO, "out of memory for %d unknowns", residual->n);
  }
  *out = s;
  return SHB_OK;
}

void mhb_condensation_destroy(mhb_condensation *s) {
  if (!s) return;
  free(s->kind);
  free(s->have);
  free(s->moving);
  free(s->stuck);
  free(s->factored);
  free(s->pivot);
  free(s->A_pivot);
  free(s->dense);
  free(s->y);
  free(s->A);
  free(s->reach);
  free(s->mixed);
  free(s->f);
  free(s->c);
  free(s->t);
  free(s->q);
  free(s->s);
  free(s);
}

/* ---- vectors ---- */

/* Real form to harmonics [k][3 pairs] and back. */
static void to_harmonics(const mhb_condensation *s, const double *x, double complex *X) {
  size_t n3 = rows_of(s);
  int    nb = s->b->nb;
  for (size_t row = 0; row < n3; row++, x += nb) {
    X[row] = x[0];
    for (int k = 1; k <= s->b->m; k++) X[(size_t)k * n3 + row] = CMPLX(x[2 * k - 1], x[2 * k]);
  }
}

static void to_real(const mhb_condensation *s, const double complex *X, double *x) {
  size_t n3 = rows_of(s);
  int    nb = s->b->nb;
  for (size_t row = 0; row < n3; row++, x += nb) {
    x[0] = creal(X[row]);
    for (int k = 1; k <= s->b->m; k++) {
      x[2 * k - 1] = creal(X[(size_t)k * n3 + row]);
      x[2 * k]     = cimag(X[(size_t)k * n3 + row]);
    }
  }
}

static const double complex *receptance(const mhb_condensation *s, int k, int row) {
  size_t n3 = rows_of(s);
  return s->b->receptance->R + ((size_t)k * n3 + (size_t)row) * n3;
}

/* sum over the listed pairs of R[row] p */
static double complex response(const double complex *R, int n, const int *pair,
                               const double complex *p) {
  double re = 0, im = 0;
  for (int j = 0; j < n; j++)
    for (int c = 3 * pair[j]; c < 3 * pair[j] + 3; c++) {
      re += creal(R[c]) * creal(p[c]) - cimag(R[c]) * cimag(p[c]);
      im += creal(R[c]) * cimag(p[c]) + cimag(R[c]) * creal(p[c]);
    }
  return CMPLX(re, im);
}

/* Harmonic k of an array [border][k][3 pairs]. */
static double complex *border(const mhb_condensation *s, double complex *array, int j, int k) {
  return array + ((size_t)j * ((size_t)s->b->m + 1) + (size_t)k) * rows_of(s);
}

static int is_zero(size_t n, const double complex *x) {
  for (size_t i = 0; i < n; i++)
    if (creal(x[i]) != 0 || cimag(x[i]) != 0) return 0;
  return 1;
}

/* ---- the stuck pairs ---- */

static void list_pairs(mhb_condensation *s) {
  s->n_moving = s->n_stuck = s->n_held = 0;
  for (int a = 0; a < s->b->n_pairs; a++) {
    mhb_pair_kind kind = s->b->eval->kind[a];
    if (kind == MHB_PAIR_AT_LIMIT) {
      kind = s->n_held < MHB_MOST_AT_LIMIT ? MHB_PAIR_STUCK : MHB_PAIR_NONLINEAR;
      if (kind == MHB_PAIR_STUCK) s->held[s->n_held++] = a;
    }
    if (kind == MHB_PAIR_NONLINEAR) s->moving[s->n_moving++] = a;
    if (kind == MHB_PAIR_STUCK) s->stuck[s->n_stuck++] = a;
    s->kind[a] = kind;
  }
}

/* A = I + R_LL S of harmonic k, column-major, factored, unless it is there. */
static int factor_harmonic(mhb_condensation *s, int k) {
  int             nl = 3 * s->n_stuck;
  size_t          at = (size_t)k * rows_of(s);
  double complex *A  = s->A + at * rows_of(s);
  if (s->have[k] || nl == 0) return 1;
  for (int i = 0; i < nl; i++) {
    const double complex *R = receptance(s, k, 3 * s->stuck[i / 3] + i % 3);
    for (int j = 0; j < s->n_stuck; j++) {
      double complex column[3]; /* S is symmetric: R S = (S R^T)^T */
      mhb_stick_force(&s->b->law[s->stuck[j]], k, R + 3 * s->stuck[j], column);
      for (int c = 0; c < 3; c++)
        A[(size_t)(3 * j + c) * (size_t)nl + (size_t)i] = column[c] + (i == 3 * j + c);
    }
  }
  return s->have[k] = (char)mhb_factor_complex(nl, A, s->A_pivot + at);
}

/* x_L <- A^-1 x_L, and the forces of it into s->s; x[3 pairs] of one harmonic. */
static int solve_stuck(mhb_condensation *s, int k, double complex *x) {
  int             nl    = 3 * s->n_stuck;
  double complex *force = s->s + (size_t)k * rows_of(s), packed[nl + 1];
  size_t          at    = (size_t)k * rows_of(s);
  if (nl == 0) return 1;
  for (int i = 0; i < nl; i++) packed[i] = x[3 * s->stuck[i / 3] + i % 3];
  if (is_zero((size_t)nl, packed)) {
    memset(force, 0, sizeof *force * rows_of(s));
    return 1;
  }
  mhb_receptance_update(s->b->receptance, k);
  if (!factor_harmonic(s, k)) return 0;
  if (!mhb_solve_complex(nl, s->A + at * rows_of(s), s->A_pivot + at, 1, packed)) return 0;
  for (int i = 0; i < s->n_stuck; i++) {
    int a = s->stuck[i];
    memcpy(x + 3 * a, packed + 3 * i, 3 * sizeof *x);
    mhb_stick_force(&s->b->law[a], k, x + 3 * a, force + 3 * a);
  }
  return 1;
}

/* What the moving pairs see of each other: directly, and through the stuck ones. */
static int condense_harmonic(mhb_condensation *s, int k) {
  int             nl = 3 * s->n_stuck, nm = 3 * s->n_moving;
  size_t          at    = (size_t)k * rows_of(s);
  double complex *reach = s->reach + at * rows_of(s), *mixed = s->mixed + at * rows_of(s);
  for (int i = 0; i < nm; i++) {
    const double complex *R = receptance(s, k, 3 * s->moving[i / 3] + i % 3);
    for (int j = 0; j < nm; j++) mixed[i * nm + j] = R[3 * s->moving[j / 3] + j % 3];
  }
  if (nl == 0) return 1;
  for (int i = 0; i < nl; i++) {
    const double complex *R = receptance(s, k, 3 * s->stuck[i / 3] + i % 3);
    for (int j = 0; j < nm; j++) reach[j * nl + i] = R[3 * s->moving[j / 3] + j % 3];
  }
  if (!mhb_solve_complex(nl, s->A + at * rows_of(s), s->A_pivot + at, nm, reach)) return 0;
  /* the room behind reach holds R_ML S, row by row */
  double complex *pull = reach + (size_t)nm * (size_t)nl;
  for (int i = 0; i < nm; i++) {
    const double complex *R = receptance(s, k, 3 * s->moving[i / 3] + i % 3);
    for (int j = 0; j < s->n_stuck; j++)
      mhb_stick_force(&s->b->law[s->stuck[j]], k, R + 3 * s->stuck[j],
                      pull + (size_t)i * (size_t)nl + 3 * j);
  }
  cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasTrans, nm, nm, nl, &MINUS, pull, nl, reach, nl,
              &ONE, mixed, nm);
  return 1;
}

static int same_factors(const mhb_condensation *s) {
  return s->omega == s->b->receptance->omega && s->n_laws == s->b->n_laws &&
         s->n_factored == s->n_stuck &&
         memcmp(s->factored, s->stuck, sizeof(int) * (size_t)s->n_stuck) == 0;
}

/* What the moving pairs couple, they couple at all harmonics; without them a harmonic is factored when it is met. */
static int condense(mhb_condensation *s) {
  int ok = 1, last = s->n_moving > 0 ? s->b->m : -1;
  if (!same_factors(s)) memset(s->have, 0, (size_t)s->b->m + 1);
  for (int k = 0; k <= last; k++) mhb_receptance_update(s->b->receptance, k);
#pragma omp parallel for schedule(dynamic, 1) reduction(&& : ok) if (3 * s->n_stuck >= WORTH_THREADS)
  for (int k = 0; k <= last; k++) ok = ok && factor_harmonic(s, k) && condense_harmonic(s, k);
  s->omega      = ok ? s->b->receptance->omega : NAN;
  s->n_factored = s->n_stuck;
  s->n_laws     = s->b->n_laws;
  memcpy(s->factored, s->stuck, sizeof(int) * (size_t)s->n_stuck);
  return ok;
}

/* ---- the dense system ---- */

static double real_product(double complex a, double complex b) {
  return creal(a) * creal(b) + cimag(a) * cimag(b);
}

/* A single number, as where nothing moves, needs no factors. */
static int factor_dense(mhb_condensation *s) {
  if (s->size == 1) s->pivot[0] = 1;
  if (s->size <= 1) return s->size == 0 || s->dense[0] != 0;
  return LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, s->size, s->size, s->dense, s->size, s->pivot) == 0;
}

static int solve_dense(mhb_condensation *s) {
  if (s->size == 1) s->y[0] /= s->dense[0];
  return s->size <= 1 || LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', s->size, 1, s->dense, s->size,
                                             s->pivot, s->y, s->size) == 0;
}

/* Rows (moving i, axis c, harmonic k): I + mixed D. */
static void dense_rows(mhb_condensation *s, int k) {
  const mhb_balance    *b  = s->b;
  int                   nm = 3 * s->n_moving, block = 3 * b->nb, first = k ? 2 * k - 1 : 0;
  const double complex *mixed = s->mixed + (size_t)k * rows_of(s) * rows_of(s);
  double                nothing[block];
  for (int i = 0; i < nm; i++) {
    int     row = i * b->nb + first;
    double *re = s->dense + (size_t)row * (size_t)s->size, *im = re + s->size;
    memset(re, 0, sizeof(double) * (size_t)s->size * (k ? 2 : 1));
    for (int j = 0; j < s->n_moving; j++)
      mhb_balance_row_times_dp(b, mixed + i * nm + 3 * j, s->moving[j], k, re + j * block,
                               k ? im + j * block : nothing);
    re[row] += 1;
    if (k) im[row + 1] += 1;
  }
}

/* Row of the dense system, moving row i of harmonic k or a border. */
static double *dense_row(const mhb_condensation *s, int row) {
  return s->dense + (size_t)row * (size_t)s->size;
}

/* Column j of the borders, c_M - R_ML S A^-1 c_L; c_L becomes A^-1 c_L. */
static int border_column(mhb_condensation *s, int j) {
  int nb = s->b->nb, column = s->size - s->n_borders + j;
  for (int k = 0; k <= s->b->m; k++) {
    double complex *c = border(s, s->c, j, k), *force = s->s + (size_t)k * rows_of(s);
    if (!solve_stuck(s, k, c)) return 0;
    for (int i = 0; i < 3 * s->n_moving; i++) {
      int            row = 3 * s->moving[i / 3] + i % 3;
      double complex y   = c[row] - response(receptance(s, k, row), s->n_stuck, s->stuck, force);
      double        *to  = dense_row(s, i * nb + (k ? 2 * k - 1 : 0)) + column;
      *to                = creal(y);
      if (k) to[s->size] = cimag(y);
    }
  }
  return 1;
}

/* What row t asks of the forces p of stuck and moving pairs through the open ones: s->q += R_Op^H t_O. */
static void open_demand(mhb_condensation *s, int k, const double complex *t) {
  size_t          n3  = rows_of(s);
  double complex *out = s->q + (size_t)k * n3;
  memset(out, 0, n3 * sizeof *out);
  for (size_t row = 0; row < n3; row++) {
    if (s->kind[row / 3] != MHB_PAIR_OPEN) continue;
    double x = creal(t[row]), y = cimag(t[row]);
    if ((x == 0 && y == 0) || s->n_moving + s->n_stuck == 0) continue;
    mhb_receptance_update(s->b->receptance, k);
    const double complex *R = receptance(s, k, (int)row);
    for (size_t j = 0; j < n3; j++)
      out[j] += CMPLX(creal(R[j]) * x + cimag(R[j]) * y, creal(R[j]) * y - cimag(R[j]) * x);
  }
}

/* conj(reach^H t_L + R_OM^H t_O), negative, for the axes of moving pair j. */
static void row_weight(const mhb_condensation *s, int k, const double complex *t, int j,
                       double complex weight[3]) {
  int                   nl = 3 * s->n_stuck;
  size_t                at = (size_t)k * rows_of(s);
  const double complex *q  = s->q + at + 3 * s->moving[j];
  for (int c = 0; c < 3; c++) {
    const double complex *reach = s->reach + at * rows_of(s) + (size_t)(3 * j + c) * (size_t)nl;
    double complex        w     = q[c];
    for (int i = 0; i < nl; i++) w += conj(reach[i]) * t[3 * s->stuck[i / 3] + i % 3];
    weight[c] = -conj(w);
  }
}

/* t_L <- t_L - S R_OL^H t_O */
static void demand_of_stuck(mhb_condensation *s, int k, double complex *t) {
  double complex *q = s->q + (size_t)k * rows_of(s), force[3];
  for (int i = 0; i < s->n_stuck; i++) {
    int a = s->stuck[i];
    mhb_stick_force(&s->b->law[a], k, q + 3 * a, force);
    for (int c = 0; c < 3; c++) t[3 * a + c] -= force[c];
  }
}

/* Sum over what is not moving of t x. */
static double still_product(const mhb_condensation *s, const double complex *t,
                            const double complex *x) {
  double sum = 0;
  for (size_t row = 0; row < rows_of(s); row++)
    if (s->kind[row / 3] != MHB_PAIR_NONLINEAR) sum += real_product(t[row], x[row]);
  return sum;
}

/* Row i of the borders: t_M - (reach^H t_L + R_OM^H t_O)^H D, where t_L becomes t_L - S R_OL^H t_O. */
static void border_row(mhb_condensation *s, int i, const double *corner) {
  int     nb = s->b->nb, block = 3 * nb, first = s->size - s->n_borders;
  double *last = dense_row(s, first + i), nothing[block];
  memset(last, 0, sizeof(double) * (size_t)first);
  memcpy(last + first, corner, sizeof(double) * (size_t)s->n_borders);
  for (int k = 0; k <= s->b->m; k++) {
    double complex *t = border(s, s->t, i, k), weight[3];
    if (is_zero(rows_of(s), t)) continue;
    open_demand(s, k, t);
    demand_of_stuck(s, k, t);
    for (int j = 0; j < s->n_moving; j++) {
      double *to = last + j * block + (k ? 2 * k - 1 : 0);
      for (int c = 0; c < 3; c++) {
        double complex own = t[3 * s->moving[j] + c];
        to[c * nb] += creal(own);
        if (k) to[c * nb + 1] += cimag(own);
      }
      row_weight(s, k, t, j, weight);
      mhb_balance_row_times_dp(s->b, weight, s->moving[j], k, last + j * block, nothing);
    }
    for (int j = 0; j < s->n_borders; j++)
      last[first + j] -= still_product(s, t, border(s, s->c, j, k));
  }
}

/* Columns R_0 and rows -G of axis u or w of a held pair, as border j. */
static void set_held(mhb_condensation *s, int j, int pair, int axis) {
  size_t        n3 = rows_of(s), size = sizeof(double complex) * n3;
  int           nb = s->b->nb;
  const double *G  = mhb_balance_mean_friction_row(s->b, pair, axis);
  mhb_receptance_update(s->b->receptance, 0);
  for (int row = 0; row < (int)n3; row++)
    border(s, s->c, j, 0)[row] = receptance(s, 0, row)[3 * pair + axis];
  memset(border(s, s->c, j, 0) + n3, 0, size * (size_t)s->b->m);
  memset(border(s, s->t, j, 0), 0, size * ((size_t)s->b->m + 1));
  for (int c = 0; c < 3; c++, G += nb) {
    border(s, s->t, j, 0)[3 * pair + c] = -G[0];
    for (int k = 1; k <= s->b->m; k++)
      border(s, s->t, j, k)[3 * pair + c] = CMPLX(-G[2 * k - 1], -G[2 * k]);
  }
}

static int set_borders(mhb_condensation *s, const double *column, const double *row) {
  double corner[MHB_MOST_BORDERS];
  if (s->bordered) {
    to_harmonics(s, column, s->c);
    to_harmonics(s, row, s->t);
  }
  for (int i = 0; i < 2 * s->n_held; i++) set_held(s, s->bordered + i, s->held[i / 2], 1 + i % 2);
  for (int j = 0; j < s->n_borders; j++)
    if (!border_column(s, j)) return 0;
  for (int i = 0; i < s->n_borders; i++) {
    memset(corner, 0, sizeof corner);
    corner[i] = i < s->bordered ? row[s->b->n] : 1;
    border_row(s, i, corner);
  }
  return 1;
}

int mhb_condensation_factor(mhb_condensation *s, const double *column, const double *row) {
  list_pairs(s);
  s->bordered  = column != NULL;
  s->n_borders = s->bordered + 2 * s->n_held;
  s->size      = 3 * s->b->nb * s->n_moving + s->n_borders;
  if (s->size - s->n_borders > s->most || !condense(s)) return 0;
  for (int k = 0; k <= s->b->m && s->n_moving > 0; k++) dense_rows(s, k);
  return set_borders(s, column, row) && factor_dense(s);
}

/* ---- solution ---- */

/* Right-hand side of the dense system; f_L becomes A^-1 f_L. */
static int reduce(mhb_condensation *s, double last) {
  int     nb         = s->b->nb;
  double *of_borders = s->y + s->size - s->n_borders;
  for (int i = 0; i < s->n_borders; i++) of_borders[i] = i < s->bordered ? last : 0;
  for (int k = 0; k <= s->b->m; k++) {
    size_t          at = (size_t)k * rows_of(s);
    double complex *f  = s->f + at;
    if (!solve_stuck(s, k, f)) return 0;
    for (int i = 0; i < 3 * s->n_moving; i++) {
      int            row = 3 * s->moving[i / 3] + i % 3, to = i * nb + (k ? 2 * k - 1 : 0);
      double complex y = f[row] - response(receptance(s, k, row), s->n_stuck, s->stuck, s->s + at);
      s->y[to]         = creal(y);
      if (k) s->y[to + 1] = cimag(y);
    }
    for (int i = 0; i < s->n_borders; i++)
      of_borders[i] -= still_product(s, border(s, s->t, i, k), f);
  }
  return 1;
}

/* q = D x_M, x_M in s->y. */
static void moving_forces(mhb_condensation *s) {
  int nb = s->b->nb, block = 3 * nb;
  for (int i = 0; i < s->n_moving; i++) {
    const double *D = s->b->eval->dp + (size_t)s->moving[i] * (size_t)block * (size_t)block,
                 *x = s->y + i * block;
    double p[block];
    cblas_dgemv(CblasRowMajor, CblasNoTrans, block, block, 1, D, block, x, 1, 0, p, 1);
    for (int c = 0; c < 3; c++)
      for (int k = 0; k <= s->b->m; k++)
        s->q[(size_t)k * rows_of(s) + (size_t)(3 * s->moving[i] + c)] =
            k ? CMPLX(p[c * nb + 2 * k - 1], p[c * nb + 2 * k]) : p[c * nb];
  }
}

/* Harmonic k of the stuck and the open pairs, from q and the borders; f becomes x. */
static void expand(mhb_condensation *s, int k) {
  int                   nl = 3 * s->n_stuck, nm = 3 * s->n_moving;
  size_t                n3 = rows_of(s), at = (size_t)k * n3;
  const double complex *reach = s->reach + at * n3;
  double complex       *x     = s->f + at;
  for (int j = 0; j < s->n_borders; j++) {
    const double complex *c     = border(s, s->c, j, k);
    double                sigma = s->y[s->size - s->n_borders + j];
    for (int row = 0; row < (int)n3; row++)
      if (s->kind[row / 3] != MHB_PAIR_NONLINEAR) x[row] -= sigma * c[row];
  }
  for (int j = 0; j < nm; j++) {
    double complex q = s->q[at + (size_t)(3 * s->moving[j / 3] + j % 3)];
    for (int i = 0; i < nl; i++) x[3 * s->stuck[i / 3] + i % 3] -= reach[j * nl + i] * q;
  }
  for (int i = 0; i < s->n_stuck; i++) {
    int a = s->stuck[i];
    mhb_stick_force(&s->b->law[a], k, x + 3 * a, s->s + at + 3 * a);
  }
  for (int row = 0; row < (int)n3 && nl + nm > 0; row++) {
    if (s->kind[row / 3] != MHB_PAIR_OPEN) continue;
    const double complex *R = receptance(s, k, row);
    x[row] -= response(R, s->n_moving, s->moving, s->q + at) +
              response(R, s->n_stuck, s->stuck, s->s + at);
  }
  for (int i = 0; i < nm; i++) {
    const double *y                 = s->y + i * s->b->nb + (k ? 2 * k - 1 : 0);
    x[3 * s->moving[i / 3] + i % 3] = k ? CMPLX(y[0], y[1]) : y[0];
  }
}

int mhb_condensation_solve(mhb_condensation *s, double *rhs) {
  to_harmonics(s, rhs, s->f);
  if (!reduce(s, s->bordered ? rhs[s->b->n] : 0) || !solve_dense(s)) return 0;
  moving_forces(s);
  for (int k = 0; k <= s->b->m; k++) expand(s, k);
  to_real(s, s->f, rhs);
  if (s->bordered) rhs[s->b->n] = s->y[s->size - s->n_borders];
  for (int i = 0; i < s->b->n + s->bordered; i++)
    if (!isfinite(rhs[i])) return 0;
  return 1;
}

int mhb_condensation_sign(const mhb_condensation *s) {
  size_t n    = (size_t)s->size;
  int    sign = 1;
  for (size_t i = 0; i < n; i++) {
    if (s->dense[i * n + i] < 0) sign = -sign;
    if (s->pivot[i] != (int)i + 1) sign = -sign;
  }
  return sign;
}
